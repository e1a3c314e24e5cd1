#include "mbd/simulation/extremes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

// Numbers without a unit have nothing in common but that 1 means something to most of them. Some have poles, as a margin
// has where nothing loads a joint, and a range that says nothing of their least value: that is located to a millionth of
// itself. Before a load has come such a number is one over rounding, of which no more than its size is followed.
double tolerance_of_number(const ChannelRange& channel, double resolution, double rounding) {
  const double range = channel.high.value - channel.low.value;
  const double near = std::min(std::abs(channel.low.value), std::abs(channel.high.value));
  if (std::isinf(near)) return 0.0;
  if (near > ExtremeFinder::k_at_pole) return 0.5 * near;
  const double size = std::max(1.0, near);
  return resolution * (range < size ? range : size) + rounding * size;
}

} // namespace

// What an extreme is located to.
double ExtremeFinder::tolerance(std::size_t c) const {
  if (ranges_[c].channel->unit.empty()) return tolerance_of_number(ranges_[c], k_resolution, k_rounding);
  const Kind& kind = kinds_[kind_[c]];
  const double range = ranges_[c].high.value - ranges_[c].low.value;
  const double wanted =
      k_resolution * (std::isfinite(range) ? range : 0.0) + k_noise * kind.range + k_rounding * std::max(kind.largest, kind.scale);
  return jitter_.empty() ? wanted : std::max(wanted, jitter_[c]);
}

// Sizes beside which rounding is seen where everything rests: of lengths, of the forces at the start over all masses.
void ExtremeFinder::set_scales() {
  const auto kind_of = [this](const char* unit) -> Kind* {
    for (std::size_t c = 0; c < count_; ++c)
      if (ranges_[c].channel->unit == unit) return &kinds_[kind_[c]];
    return nullptr;
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
