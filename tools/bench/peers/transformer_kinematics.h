#pragma once

// Pose and velocity of body 1 relative to body 5, and gaps of the contacts.

#include "transformer_parameters.h"

namespace steplap::peers::transformer {

struct Turn {
  double sine, cosine, versine; // `versine`: cosine − 1
};

// Largest angle, rad, for which short series replace sine and cosine. They are exact to rounding and, unlike divisions, can be evaluated in
// parallel; angles of this scene are a few mrad.
inline constexpr double k_small = 0.01;

inline Turn turn(double x) {
  if (std::abs(x) > k_small) [[unlikely]]
    return {std::sin(x), std::cos(x), std::cos(x) - 1.0};
  const double z = x * x;
  const double versine = z * (-0.5 + z * (1.0 / 24.0 - z * (1.0 / 720.0)));
  return {x + x * z * (-1.0 / 6.0 + z * (1.0 / 120.0)), 1.0 + versine, versine};
}

struct Ratios {
  double secant, tangent;
};

inline Ratios ratios(double x, const Turn& of_x) {
  if (std::abs(x) > k_small) [[unlikely]]
    return {1.0 / of_x.cosine, of_x.sine / of_x.cosine};
  const double z = x * x;
  return {1.0 + z * (0.5 + z * (5.0 / 24.0 + z * (61.0 / 720.0))), x + x * z * (1.0 / 3.0 + z * (2.0 / 15.0 + z * (17.0 / 315.0)))};
}

// Pose and velocity of body 1 relative to body 5, in the axes of body 5: (rx, ry) from the centre of body 5 to that of body 1, and phi = θ1
// − θ5.
struct Kinematics {
  double c, s, versine;          // cosine, sine and versine of θ5
  double cp, sp, sec, tan, sec2; // functions of phi
  double rx, ry, rxd, ryd, phid;
  double ut, un; // relative velocity of the centres, along and normal to the floor
  double d;      // height of the centre of body 1 above the floor line
};

inline Kinematics kinematics(const double* y) {
  Kinematics k;
  const Turn five = turn(y[4]);
  const Turn phi = turn(y[2] - y[4]);
  const Ratios of_phi = ratios(y[2] - y[4], phi);
  const double height = y[1] - y[3];
  const double u = y[6];
  const double v = y[7] - y[9];
  k.c = five.cosine;
  k.s = five.sine;
  k.versine = five.versine;
  k.cp = phi.cosine;
  k.sp = phi.sine;
  k.sec = of_phi.secant;
  k.tan = of_phi.tangent;
  k.sec2 = k.sec * k.sec;
  k.rx = k.c * y[0] + k.s * height;
  k.ry = k.c * height - k.s * y[0];
  k.ut = k.c * u + k.s * v;
  k.un = k.c * v - k.s * u;
  k.rxd = k.ut + y[10] * k.ry;
  k.ryd = k.un - y[10] * k.rx;
  k.phid = y[8] - y[10];
  k.d = k.ry + k_height_lower;
  return k;
}

// Returns the gap δ of a contact without preload, m. Feet: δ = n·(p_A − p_B)/(n·a), with a the y axis of body 1. Blocks: a = n, from the
// marker on the cover to the top line of body 1.
inline double gap(int contact, const Kinematics& k, const double* y) {
  const double place = k_place[contact];
  if (contact < 2) return k.d * k.sec + place * k.tan - k_height_active;
  return -k.sp * (y[5] + place - k.rx) + k.cp * (k_cover - k.ry) - k_block_plane;
}

inline double gap_rate(int contact, const Kinematics& k, const double* y) {
  const double place = k_place[contact];
  if (contact < 2) return k.ryd * k.sec + (k.d * k.sec * k.tan + place * k.sec2) * k.phid;
  const double lever = -k.cp * (y[5] + place - k.rx) - k.sp * (k_cover - k.ry);
  return k.sp * (k.rxd - y[11]) - k.cp * k.ryd + lever * k.phid;
}

} // namespace steplap::peers::transformer
