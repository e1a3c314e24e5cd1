#include "mbd/simulation/extremes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

// Returns the tolerance for extremes of a channel without unit. Such channels have no common scale, but for most of them the value 1 is
// significant. Some have poles, such as a margin while a joint is unloaded; their range then gives no scale for the minimum, which is
// located to 1e-6 of itself. Before a load begins such a value is the reciprocal of a rounding error, and only its magnitude is meaningful.
double tolerance_of_number(const ChannelRange& channel, double resolution, double rounding) {
  const double range = channel.high.value - channel.low.value;
  const double near = std::min(std::abs(channel.low.value), std::abs(channel.high.value));
  if (std::isinf(near)) return 0.0;
  if (near > ExtremeFinder::k_at_pole) return 0.5 * near;
  const double size = std::max(1.0, near);
  return resolution * (range < size ? range : size) + rounding * size;
}

} // namespace

// Returns the accuracy to which extremes of a channel are located, in the unit of the channel.
double ExtremeFinder::tolerance(std::size_t c) const {
  if (range(c).channel->unit.empty()) return tolerance_of_number(range(c), k_resolution, k_rounded_range);
  const Kind& kind = kinds_[kind_[c]];
  const double spread = range(c).high.value - range(c).low.value;
  const double wanted =
      k_resolution * (std::isfinite(spread) ? spread : 0.0) + k_noise * kind.range + k_rounded_range * std::max(kind.largest, kind.scale);
  return jitter_.empty() ? wanted : std::max(wanted, jitter_[c]);
}

// Sets the magnitudes against which rounding errors are compared while everything is at rest: a length, and for accelerations the forces at
// the start divided by the total mass.
void ExtremeFinder::set_scales() {
  const auto kind_of = [this](const char* unit) -> Kind* {
    const auto found = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& each) { return *each.unit == unit; });
    return found == kinds_.end() ? nullptr : &*found;
  };
  const auto largest = [&](const char* unit) { return kind_of(unit) ? kind_of(unit)->largest : 0.0; };
  double mass = 0.0;
  for (const BodyData& body : system_.bodies) mass += body.mass;
  const double length = largest("m") > 0.0 ? largest("m") : 1.0;
  const double force = std::max(largest("N"), mass * system_.gravity.norm()), a = mass > 0.0 ? force / mass : 0.0;
  const double v = std::sqrt(a * length);
  const std::pair<const char*, double> scales[] = {{"m", length},    {"rad", 1.0},
                                                   {"m/s", v},       {"rad/s", v / length},
                                                   {"m/s^2", a},     {"rad/s^2", a / length},
                                                   {"N", force},     {"N m", force * length},
                                                   {"W", force * v}, {"J", force * length}};
  for (const auto& [unit, scale] : scales)
    if (Kind* kind = kind_of(unit)) kind->scale = scale;
}

} // namespace steplap
