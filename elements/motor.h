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
  std::string effort;               ///< name of the signal of the effort, N m or N
  double constant_effort = 0.0;
  std::optional<double> no_load_speed; ///< speed in the direction of the effort at which the effort becomes zero, rad/s or m/s
  std::string target;                  ///< name of the signal of the target position, rad or m
  double proportional = 0.0, derivative = 0.0;
};

[[nodiscard]] const ElementKind& motor_kind();

} // namespace steplap
