// Motor: a couple or force along a coordinate of a against b that a signal, the speed and a wanted position
// decide, its opposite on b. (A motion that is followed exactly is a prescribed_motion.)
//
//   f = effort(t) − |effort(t)| rate/no_load_speed + kp (target(t) − value) + kd (target'(t) − rate)
// The first terms are a motor with a straight characteristic: `effort` is what it gives at standstill, the
// couple falls to zero at the no-load speed, forwards as well as in reverse. The others are a servo. value is measured
// from the reference pose.
// All of f's power is booked as work.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Motor : Element {
  std::string a, b = "ground";
  std::string coordinate = "angle"; ///< angle, x, y (marker b's axes), distance
  std::string effort;               ///< signal, N m or N
  double constant_effort = 0.0;
  std::optional<double> no_load_speed; ///< rad/s or m/s, in the direction of the effort
  std::string target;                  ///< signal, rad or m
  double proportional = 0.0, derivative = 0.0;
};

[[nodiscard]] const ElementKind& motor_kind();

} // namespace steplap
