// Motor: a moment or force along a coordinate of a relative to b that depends on a signal, the speed and a target position; the opposite
// acts on b. (Use prescribed_motion for a motion that is followed exactly.)
//
//   f = effort(t) − |effort(t)| rate/no_load_speed + kp (target(t) − value) + kd (target'(t) − rate)
//
// The first two terms are a motor with linear characteristic: `effort` is the stall torque, which decreases to zero at the no-load speed,
// in both directions. The other terms are a servo drive. value is measured from the reference pose. All power of f is counted as work.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Motor : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle"; ///< angle, x, y (marker b's axes) or distance
  std::string effort;               ///< signal, N m or N
  double constant_effort = 0.0;
  std::optional<double> no_load_speed; ///< rad/s or m/s, in the direction of the effort
  std::string target;                  ///< signal, rad or m
  double proportional = 0.0, derivative = 0.0;
};

[[nodiscard]] const ElementKind& motor_kind();

} // namespace steplap
