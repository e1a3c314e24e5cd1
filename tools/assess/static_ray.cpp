#include "tools/assess/static_ray.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

// first step of the pull, as a fraction of gravity, or of the largest pull if there is no gravity
constexpr double k_first_step = 1.0 / 16.0;
constexpr double k_growth = 1.3;
constexpr double k_width = 1e-6; // relative accuracy of the acceleration of a limit
// a reserve below this fraction of its value at rest is at its limit; 100 times the change over an interval of width k_width
constexpr double k_at_limit = 1e-4;
constexpr int k_most_probes = 80;

struct Point {
  double a = 0.0;
  Probe probe;
};

class Ray {
public:
  Ray(StaticMachine& machine, const Vec2& direction, double most)
      : machine_(machine), direction_(direction), most_(most), is_reached_(machine.watches().size(), 0) {}

  StaticRay run() {
    Point low{0.0, machine_.at_rest()};
    for (std::size_t w = 0; w < is_reached_.size(); ++w)
      if (!(low.probe.left[w] > 0.0)) note(w, 0.0, 0.0);
    const double g = machine_.gravity().norm();
    const double first = k_first_step * (g > 0.0 ? std::min(g, most_) : most_);
    for (double a = std::min(first, most_);; a = std::min(most_, std::max(a + first, a * k_growth))) {
      Point high = at(low, a);
      if (!high.probe.rest) {
        locate_end(low, high);
        break;
      }
      locate_limits(low, high);
      low = std::move(high);
      found_.largest = a;
      if (a >= most_) break;
    }
    std::stable_sort(found_.limits.begin(), found_.limits.end(),
                     [](const StaticLimit& x, const StaticLimit& y) { return x.acceleration < y.acceleration; });
    return std::move(found_);
  }

private:
  [[nodiscard]] Point at(const Point& low, double a) { return {a, machine_.ramped_from(low.probe, a * direction_)}; }

  void note(std::size_t w, double a, double error) {
    is_reached_[w] = 1;
    const Watch& watch = machine_.watches()[w];
    found_.limits.push_back({watch.kind, watch.element, "'" + watch.element + "' " + name_of(watch.kind), a, error});
  }

  // Returns the acceleration at which the reserve of monitored limit w, extrapolated linearly, is zero.
  [[nodiscard]] static double predicted_limit(const Point& before, const Point& low, std::size_t w) {
    const double slope = (low.probe.left[w] - before.probe.left[w]) / (low.a - before.a);
    return slope < 0.0 ? low.a - low.probe.left[w] / slope : low.a - 1.0;
  }

  // Returns the smallest predicted acceleration of the limits that were not reached yet, or of limit `only`.
  [[nodiscard]] double predicted_limit(const Point& before, const Point& low, std::optional<std::size_t> only) const {
    double first = low.a - 1.0;
    for (std::size_t w = 0; w < is_reached_.size(); ++w) {
      if (only ? w != *only : is_reached_[w] != 0) continue;
      const double a = predicted_limit(before, low, w);
      if (a > low.a && (first < low.a || a < first)) first = a;
    }
    return first;
  }

  // Bisects between `low`, where `is_good` is true, and `high`, where it is false. Two of three iterations use a prediction instead of the
  // midpoint.
  template <class IsGood> void bisect(Point& low, Point& high, std::optional<std::size_t> only, const IsGood& is_good) {
    Point before = low;
    for (int i = 0; i < k_most_probes; ++i) {
      const double width = high.a - low.a, enough = k_width * high.a;
      if (width <= enough) return;
      double next = low.a + 0.5 * width;
      if (i % 3 != 2 && low.a > before.a) {
        const double guess = predicted_limit(before, low, only), aside = 0.3 * enough;
        if (guess > low.a && guess < high.a) next = i % 3 == 0 ? guess - aside : guess + aside;
      }
      if (!(next > low.a && next < high.a)) next = low.a + 0.5 * width;
      Point middle = at(low, next);
      if (is_good(middle.probe)) {
        before = std::move(low);
        low = std::move(middle);
      } else {
        high = std::move(middle);
      }
    }
  }

  // Locates the limits that are reached between two equilibria.
  void locate_limits(const Point& from, const Point& to) {
    for (std::size_t w = 0; w < is_reached_.size(); ++w) {
      if (is_reached_[w] != 0 || to.probe.left[w] > 0.0) continue;
      Point low = from, high = to;
      bisect(low, high, w, [w](const Probe& p) { return p.rest && p.left[w] > 0.0; });
      note(w, 0.5 * (low.a + high.a), 0.5 * (high.a - low.a));
    }
  }

  void locate_end(const Point& from, const Point& to) {
    Point low = from, high = to;
    if (to.probe.reached) low = {to.probe.reached->pull.dot(direction_), *to.probe.reached};
    bisect(low, high, std::nullopt, [](const Probe& p) { return p.rest.has_value(); });
    locate_limits(from, low);
    found_.largest = low.a;
    const double a = 0.5 * (low.a + high.a), error = 0.5 * (high.a - low.a);
    for (std::size_t w = 0; w < is_reached_.size(); ++w)
      if (is_reached_[w] == 0 && low.probe.left[w] <= k_at_limit * std::max(1.0, machine_.at_rest().left[w])) note(w, a, error);
    found_.is_explained = !high.probe.is_unknown;
    found_.limits.push_back({LimitKind::ends, "", high.probe.failure, a, error});
  }

  StaticMachine& machine_;
  const Vec2 direction_;
  const double most_;
  std::vector<char> is_reached_;
  StaticRay found_;
};

} // namespace

StaticRay grow_pull(StaticMachine& machine, const Vec2& direction, double most) { return Ray(machine, direction, most).run(); }

} // namespace steplap::assess
