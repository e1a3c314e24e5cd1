// ExtremeFinder: extremes of channels with a kink, by golden-section search on the motion itself.
//
// The search treats one channel after the other, but a kink usually affects many: when a joint starts to slip, its wrench, its utilisation
// and all related accelerations change together, and their searches evaluate the same points. The values of all channels at a point are
// therefore stored for the channels that follow; they are bit-identical to separate evaluations. For noisy channels, whose searches
// evaluate different points, storing soon stops: evaluating all of them at each point would cost the square of their number.
#include "mbd/simulation/extremes.h"

#include "mbd/base/diagnostics.h"
#include "mbd/simulation/node_polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <vector>

namespace steplap {

namespace {

constexpr int k_last = NodePolynomial::k_last; // index of the last node, at the end of the stretch
constexpr int k_most_sections = 40;
constexpr double k_same_place = 1e-7; // smallest interval relative to the stretch; its square is the remaining error of a maximum
constexpr double k_golden = 0.3819660112501051;
// Storing stops if after this number of points fewer than one in k_least_use was reused.
constexpr std::size_t k_trial = 50, k_least_use = 4;
constexpr std::size_t k_most_kept = std::size_t{1} << 20U; // largest number of stored values (16 MB)

// Finds the nodes that are higher than both neighbours, the highest first. Golden-section searches start there.
int tops_of(const std::vector<std::vector<double>>& nodes, std::size_t c, double sign, std::array<int, k_last - 1>& middles) {
  int count = 0;
  for (int middle = 1; middle < k_last; ++middle) {
    const auto is_below = [&](int i) { return !(sign * nodes[i][c] > sign * nodes[middle][c]); };
    // The neighbour of an end may count as highest even if the end is higher, because the curve may have a maximum between them.
    const bool is_top = (is_below(middle - 1) || middle == 1) && (is_below(middle + 1) || middle == k_last - 1);
    if (is_top) middles[count++] = middle;
  }
  std::sort(middles.begin(), middles.begin() + count, [&](int i, int j) { return sign * nodes[i][c] > sign * nodes[j][c]; });
  return count;
}

// Finds the maximum of value() between a and b by golden sections, until the values differ by at most flat(). Evaluations may change
// flat().
template <class Value, class Flat> void find_top(double a, double b, const Value& value, const Flat& flat) {
  double p = a + k_golden * (b - a), q = b - k_golden * (b - a), at_p = value(p), at_q = value(q);
  for (int i = 0; i < k_most_sections && b - a > k_same_place; ++i) {
    const bool is_left = at_p > at_q;
    if (std::abs(at_p - at_q) <= flat() && b - a < 0.01) break;
    (is_left ? b : a) = is_left ? q : p;
    if (is_left) {
      q = p;
      at_q = at_p;
      at_p = value(p = a + k_golden * (b - a));
    } else {
      p = q;
      at_p = at_q;
      at_q = value(q = b - k_golden * (b - a));
    }
  }
}

/// Evaluated points of the present stretch, with the values of channels there.
class Places {
public:
  struct Place {
    bool is_singular = false; ///< near a singular position of joints
    /// Values in the order of the open channels; empty for channels already finished, or if the evaluation failed.
    std::vector<std::optional<double>> value;
  };

  /// Returns the object of this thread; its memory is reused for all stretches.
  static Places& of_thread() {
    static thread_local Places places;
    return places;
  }
  void clear() {
    count_ = made_ = used_ = 0;
    number_.clear();
  }
  /// Returns true if stored points are reused often enough.
  [[nodiscard]] bool are_of_use() const { return made_ < k_trial || k_least_use * used_ >= made_; }
  void note_use() { ++used_; }
  /// Returns the point if the value of the channel is stored there, otherwise null.
  [[nodiscard]] const Place* at(double theta, std::size_t channel) const {
    const auto known = number_.find(theta);
    return known != number_.end() && places_[known->second].value[channel] ? &places_[known->second] : nullptr;
  }
  /// Adds a point at theta with empty values of `channels` channels. Replaces an earlier point with the same theta.
  [[nodiscard]] Place& add(double theta, std::size_t channels) {
    if ((count_ + 1) * channels > k_most_kept) clear();
    if (count_ == places_.size()) places_.emplace_back();
    number_[theta] = count_;
    ++made_;
    Place& place = places_[count_++];
    place.is_singular = false;
    place.value.assign(channels, std::nullopt);
    return place;
  }

private:
  std::vector<Place> places_;                      ///< the first count_ entries are in use
  std::size_t count_ = 0, made_ = 0, used_ = 0;    ///< number of points stored; computed in the stretch; reused
  std::unordered_map<double, std::size_t> number_; ///< index of a point by theta
};

} // namespace

void ExtremeFinder::section(std::size_t c, Integrator& integrator, Dynamics& dynamics) {
  Places& places = Places::of_thread();
  if (c == open_.front()) places.clear(); // first channel of a new stretch
  const auto own = static_cast<std::size_t>(std::find(open_.begin(), open_.end(), c) - open_.begin());
  const auto search_all_extremes = [&](double theta) -> const Places::Place& {
    const Snapshot snapshot = evaluate_dense(theta, integrator, dynamics);
    Places::Place& place = places.add(theta, open_.size());
    place.is_singular = is_singular_;
    place.value[own] = range(c).channel->value(snapshot);
    for (std::size_t k = own + 1; k < open_.size() && places.are_of_use(); ++k) {
      try {
        place.value[k] = range(open_[k]).channel->value(snapshot);
      } catch (const NumericalFailure&) { // not stored: reported if the channel's own search evaluates this point
      }
    }
    return place;
  };
  const auto value_at = [&](double theta) {
    const Places::Place* const known = places.at(theta, own);
    if (known) places.note_use();
    const Places::Place& place = known ? *known : search_all_extremes(theta);
    is_singular_ = place.is_singular;
    take(c, t_ + theta * (t1_ - t_), *place.value[own]);
    return *place.value[own];
  };
  for (const double sign : {1.0, -1.0}) {
    std::array<int, k_last - 1> middles;
    const int tops = tops_of(node_, c, sign, middles), count = integrator.is_adaptive() ? tops : std::min(tops, 1);
    for (int top = 0; top < count; ++top) {
      const int middle = middles[top];
      const double record = sign * (sign > 0.0 ? range(c).high.value : range(c).low.value);
      const double spread = spread_about(c, middle),
                   highest = std::max({sign * at(c, middle - 1), sign * at(c, middle), sign * at(c, middle + 1)});
      if (!(highest + spread > record + tolerance(c)) || !std::isfinite(spread)) continue;
      find_top(
          NodePolynomial::theta(middle - 1), NodePolynomial::theta(middle + 1), [&](double theta) { return sign * value_at(theta); },
          [&] { return 0.01 * tolerance(c); });
    }
  }
}

} // namespace steplap
