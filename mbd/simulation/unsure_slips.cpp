// Extremes reached during very slow slips: the slower a joint slides, the less accurate are its direction and its wrench.
#include "mbd/simulation/extremes.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace steplap {

namespace {

// Slip velocities below this multiple of the accuracy of a step have an unknown direction. Errors of steps add up; at this speed the
// direction is accurate to some thousandths.
constexpr double k_unsure = 300.0;

// Returns true if the channel depends on the direction of slip, as positions, velocities and energies do not.
bool turns_with_slips(const Channel& channel) {
  const std::string_view unit = channel.unit;
  return unit != "m" && unit != "rad" && unit != "m/s" && unit != "rad/s" && unit != "J";
}

// Returns true if a slip is so slow that its regularised law no longer has a direction.
bool is_slip_ending(const State& state) {
  return std::any_of(state.friction.begin(), state.friction.end(), [](const FrictionState& friction) {
    return friction.phase == FrictionPhase::slip && !friction.is_onset && friction.onset_stage != 0;
  });
}

} // namespace

// Updates slip_ and is_unsure_ from the last evaluation of `dynamics`. At the onset of slip the direction is known from the multipliers,
// even at zero speed. `is_new`: after an event, where a direction can become known but not unknown.
void ExtremeFinder::check_slip_directions(const Integrator& integrator, Dynamics& dynamics, bool is_new) {
  const double before = slip_;
  slip_ = std::numeric_limits<double>::infinity();
  if (integrator.is_adaptive() && dynamics.slip_scales(y_.data()))
    slip_ = *std::min_element(y_.begin(), y_.begin() + dynamics.coordinate_count());
  const bool is_known = slip_ >= k_unsure * integrator.rate_accuracy(dynamics) && !is_slip_ending(dynamics.state());
  is_unsure_ = !is_known && (is_unsure_ || (!is_new && slip_ <= before));
  if (!is_unsure_ || !known_direction_.empty()) return;
  known_direction_.resize(count_);
  for (std::size_t c = 0; c < count_; ++c) known_direction_[c] = {range(c).low.value, range(c).high.value};
}

void ExtremeFinder::begin(double t, const Snapshot& snapshot, const Integrator& integrator, Dynamics& dynamics) {
  check_slip_directions(integrator, dynamics, true);
  begin(t, snapshot);
}

void ExtremeFinder::record_known_direction(std::size_t c, double value) {
  if ((is_unsure_ && turns_with_slips(*range(c).channel)) || std::isnan(value)) return;
  KnownDirectionRange& sure = known_direction_[c];
  if (!(value >= sure.low)) sure.low = value;
  if (!(value <= sure.high)) sure.high = value;
}

} // namespace steplap
