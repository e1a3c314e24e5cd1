// The block: its centre of gravity lies in the plane of contact, so that nothing tips and the normal force is its
// weight.
#pragma once

#include <string>

namespace steplap::testing {

inline constexpr double k_g = 9.81;

inline const std::string k_block = R"(
gravity = [0, -9.81]
[simulation]
end = 1.0
tolerance = 1e-10
[[body]]
name = "block"
mass = 1000
inertia = 200
[[body]]
name = "deck"
mass = 5000
inertia = 1000
[[signal]]
name = "push"
kind = "rectangle"
peak = 5.886
start = 0.01
duration = 0.1
[[element]]
kind = "prescribed_motion"
name = "drive"
a = "deck"
coordinate = "x"
signal = "push"
as = "acceleration"
[[element]]
kind = "prismatic"
name = "road"
a = "deck"
axis = [1, 0]
[[element]]
kind = "unilateral_contact"
name = "foot"
a = "block"
b = "deck"
normal = [0, 1]
stiffness = 5e7
damping = 1e5
preload = 9810
[[element]]
kind = "prismatic"
name = "guide"
a = "block"
axis = [1, 0]
[[element]]
kind = "coulomb_stick"
name = "deck friction"
contacts = ["foot"]
static_friction = 0.3
)";

inline const std::string k_slid = "[[response]]\nname = \"slid\"\nchannel = \"deck friction.slide\"\nwhat = \"largest\"\n";

inline double slid_distance(double acceleration, double time, double mu) {
  if (acceleration <= mu * k_g) return 0.0;
  return acceleration * acceleration * time * time / (2.0 * mu * k_g) - 0.5 * acceleration * time * time;
}

} // namespace steplap::testing
