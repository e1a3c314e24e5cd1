#include "tools/assess/axis_watch.h"

#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

// Smallest number of rows to recognise a constant axis. With a coarse resolution fewer rows may be equal by chance.
constexpr std::size_t k_many = 100;
constexpr std::size_t k_most_of_rest = 100000; // largest number of rows used for the reading at rest
constexpr double k_long = 0.2;                 // shortest constant interval, s
constexpr double k_moves = 0.05 * k_gravity;   // smallest range of another axis that counts as motion, m/s²
// An axis that stays constant while another axis changes by this many of the constant axis' converter steps does not measure.
constexpr double k_coarse = 20.0;
constexpr double k_few_steps = 4.0; // largest range of an insensitive axis, in steps of its converter
constexpr double k_coupling = 0.05; // smallest fraction of another axis' motion that an axis reads because of misalignment

} // namespace

void AxisWatch::put(double t, const double* a, std::size_t axes) {
  count_ = axes;
  if (rows_++ == 0) begin_ = t;
  if (t - begin_ <= 1.0 && rows_ <= k_most_of_rest)
    for (std::size_t i = 0; i < axes; ++i) first_second_[i].push_back(a[i]);
  for (std::size_t i = 0; i < axes; ++i) {
    Axis& axis = axes_[i];
    for (NoiseWatch& noise : axis.noise) noise.put(t, a[i]);
    const bool is_changed = rows_ > 1 && a[i] != axis.value;
    axis.least = std::min(axis.least, a[i]), axis.greatest = std::max(axis.greatest, a[i]);
    if (is_changed || rows_ == 1) {
      if (is_changed) {
        ++axis.changes;
        axis.step = std::min(axis.step, std::abs(a[i] - axis.value));
        end_constant_interval(axis);
      }
      axis.value = a[i];
      axis.current = {t, t, 0, 0.0};
      std::copy(a, a + axes, axis.low.begin());
      std::copy(a, a + axes, axis.high.begin());
    }
    axis.current.to = t;
    ++axis.current.rows;
    for (std::size_t k = 0; k < axes; ++k) {
      if (k == i) continue;
      axis.low[k] = std::min(axis.low[k], a[k]), axis.high[k] = std::max(axis.high[k], a[k]);
      axis.current.others = std::max(axis.current.others, axis.high[k] - axis.low[k]);
    }
  }
}

void AxisWatch::end_constant_interval(Axis& axis) {
  const ConstantInterval& ended = axis.current;
  if (ended.rows >= k_many && ended.to - ended.from >= k_long && ended.others > axis.suspect.others) axis.suspect = ended;
}

void AxisWatch::finish() {
  for (std::size_t i = 0; i < count_; ++i) {
    end_constant_interval(axes_[i]);
    for (NoiseWatch& noise : axes_[i].noise) noise.finish();
  }
}

double AxisWatch::rest(std::size_t axis) const {
  std::vector<double> values = first_second_[axis];
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double AxisWatch::others_range(std::size_t axis) const {
  double range = 0.0;
  for (std::size_t i = 0; i < count_; ++i)
    if (i != axis) range = std::max(range, axes_[i].greatest - axes_[i].least);
  return range;
}

std::optional<AxisWatch::DeadInterval> AxisWatch::stuck(std::size_t index) const {
  const Axis& axis = axes_[index];
  if (axis.changes == 0) return rows_ >= k_many ? std::optional(DeadInterval{axis.current.from, axis.current.to}) : std::nullopt;
  if (axis.suspect.others >= std::max(k_moves, k_coarse * axis.step)) return DeadInterval{axis.suspect.from, axis.suspect.to};
  for (const NoiseWatch& noise : axis.noise) {
    const auto silence = noise.silence(axis.step);
    if (!silence) continue;
    // A constant value at either end of the axis' range is clipped, not stuck.
    const bool is_constant = silence->least == silence->greatest;
    if (is_constant && (silence->least == axis.least || silence->greatest == axis.greatest)) continue;
    return DeadInterval{silence->from, silence->to};
  }
  return {};
}

bool AxisWatch::is_insensitive(std::size_t index) const {
  const Axis& axis = axes_[index];
  const double own = axis.greatest - axis.least, others = others_range(index);
  return rows_ >= k_many && axis.changes > 0 && own <= (k_few_steps + 0.5) * axis.step && others >= 2.0 * k_moves &&
         own < k_coupling * others;
}

} // namespace steplap::assess
