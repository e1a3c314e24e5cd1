#pragma once

// Parameters of the paper's transformer, assumed where the paper gives none, and the braking pulse. The limbs are part of the active part,
// 1.25 m from the common centre of gravity.

#include "transformer_minimal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::peers::transformer {

inline constexpr double k_gravity = 9.81;

// mass of bodies 1, 2 and 3, which form one rigid body
inline constexpr double k_mass_limb = 9000.0;
inline constexpr double k_inertia_limb = 6500.0;
inline constexpr double k_limb_x = 1.25;
inline constexpr double k_mass_active = 47000.0 + 2.0 * k_mass_limb;
inline constexpr double k_inertia_active = 65200.0 + 2.0 * (k_inertia_limb + k_mass_limb * k_limb_x * k_limb_x);
inline constexpr double k_inv_mass = 1.0 / k_mass_active;
inline constexpr double k_inv_inertia = 1.0 / k_inertia_active;
inline constexpr double k_mass_upper = 20000.0;
inline constexpr double k_inertia_upper = 28000.0;
inline constexpr double k_mass_lower = 34600.0;
inline constexpr double k_inertia_lower = 55000.0;

inline constexpr double k_height_active = 1.95;                   // height of the centre of gravity above the floor, m
inline constexpr double k_height_lower = 0.79;                    // height of body 5, m
inline constexpr double k_rise_upper = 3.20 - k_height_lower;     // height of body 4 above body 5, m
inline constexpr double k_cover = 3.90 - k_height_lower;          // height of the wooden blocks above body 5, m
inline constexpr double k_block_plane = 3.90 - k_height_active;   // height of the top line of body 1 above its centre, m
inline constexpr double k_top_arrest = 3.30 - k_height_active;    // height above the centre of body 1, m
inline constexpr double k_bottom_arrest = 0.30 - k_height_active; // negative: below the centre
inline constexpr double k_suspension_drop = -0.50 - k_height_lower;

inline constexpr double k_foot_stiffness = 1.6e9, k_foot_damping = 1.5e5;
inline constexpr double k_wood_stiffness = 2e8, k_wood_damping = 5e4;
inline constexpr double k_top_stiffness = 2e8, k_top_damping = 2e5; // sum of both devices, N/m, N s/m
inline constexpr double k_bottom_stiffness = 2e8, k_bottom_damping = 4e4;
inline constexpr double k_tank_stiffness = 4e7, k_tank_damping = 4e4;
inline constexpr double k_suspension_stiffness = 2e8, k_suspension_damping = 1.5e6; // for each of the two, N/m, N s/m
inline constexpr double k_suspension_arm = 1.5;
inline constexpr double k_friction = 0.35;

inline constexpr double k_place[k_contacts] = {-1.0, 1.0, -1.2, 1.2};
inline constexpr double k_stiffness[k_contacts] = {k_foot_stiffness, k_foot_stiffness, k_wood_stiffness, k_wood_stiffness};
inline constexpr double k_damping[k_contacts] = {k_foot_damping, k_foot_damping, k_wood_damping, k_wood_damping};

inline constexpr double k_interference_force = 98100.0; // sum of both blocks, N
inline constexpr double k_wood_clearance = 0.5e-3;

inline constexpr double k_speed = 1.1 / 3.6;
inline constexpr double k_peak = 5.886;
inline constexpr double k_pulse_start = 0.05;
inline constexpr double k_pulse_length = 0.1;
inline constexpr double k_omega = 2.0 * std::numbers::pi / k_pulse_length;

inline constexpr double k_dead_band = 1e-13; // rad; smaller tilts do not change the contact foot, because they are rounding errors
inline constexpr double k_still = 1e-12;     // m/s; slower motion counts as rest

inline constexpr double k_force_scale = 1e-5, k_length_scale = 1e3, k_speed_scale = 10.0;

// Returns the acceleration of body 5, m/s².
inline double braking(double t) {
  const double s = t - k_pulse_start;
  if (s <= 0.0 || s >= k_pulse_length) return 0.0;
  return -0.5 * k_peak * (1.0 - std::cos(k_omega * s));
}

// Returns x5(t), m, the second integral of the braking pulse.
inline double travel(double t) {
  double x = k_speed * t;
  const double s = t - k_pulse_start;
  if (s <= 0.0) return x;
  const double in = std::min(s, k_pulse_length);
  x -= 0.5 * k_peak * (0.5 * in * in + (std::cos(k_omega * in) - 1.0) / (k_omega * k_omega));
  return x - 0.5 * k_peak * k_pulse_length * (s - in);
}

} // namespace steplap::peers::transformer
