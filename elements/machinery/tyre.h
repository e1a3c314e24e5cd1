// Wheel with a tyre on a road, seen from the side. It carries load, lifts off, grips, slips and locks.
//
// Body a is the wheel with its centre at marker a; the road y = h(x) is flat or a smooth curve (road.h) in the axes of marker b. With d the
// distance of the centre from the road, n the road's normal at the nearest point and t = −ẑ×n its direction:
//
//   normal force N = max(0, k (r − d) − c ḋ), along n, through the centre;
//   slip velocity v_s = t·v + r ω, of the tread relative to the road (ω relative to b; rolling forward has ω < 0);
//   rolling velocity of the tread through the contact V = |r ω|.
//
// Bristles between tread and road have the mean deflection u over the contact:
//
//   adhering     u̇ = v_s − V u/σ,  T = C/σ u + b u̇,   valid while |T| ≤ μ N
//   sliding      T = ±μ N,         u̇ = (T − C/σ u)/b,  valid while adhesion would require more than μ N
//
// T acts on the wheel against v_s. σ is the relaxation length: bristles that leave the contact are replaced by straight ones. At standstill
// (V = 0) the tread is a spring C/σ parallel to a damper b that holds exactly up to μ N. In steady rolling T = C v_s/V up to μ N, with C
// the slip stiffness; after a step of slip T approaches this value over the distance σ. (H. B. Pacejka, Tyre and Vehicle Dynamics, 3rd ed.
// 2012, ch. 7: linear single-point model, here with a bound, and with V of the tread instead of the axle, so that the bristles of a locked
// wheel stay.) At the slip μ N/C the characteristic has a corner where that of a measured tyre is rounded.
//
// Stored energy: ½ k (r − d)² and ½ C/σ u². The bristles dissipate b (u̇ + V u/2σ)² + (4 C − b V) V u²/4σ²; for V > 4 C/b this could become
// negative, therefore b is replaced by 4 C/V there. The radius for rolling is the undeformed radius r, so T acts below the road surface by
// the compression of the tyre. Valid for roads whose hollows are less curved than the wheel (checked), and for compressions that are small
// compared with both radii.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

struct Tyre : Element {
  std::string a, b = "ground";
  double radius = 0.0;            ///< radius r, m
  std::vector<Vec2> road;         ///< points (x, height) of the road, m, in marker b's axes; empty: flat
  double stiffness = 0.0;         ///< radial stiffness k, N/m
  double damping = 0.0;           ///< radial damping c, N s/m
  double friction = 0.0;          ///< coefficient of friction μ
  double slip_stiffness = 0.0;    ///< slip stiffness C, N per unit of slip
  double relaxation_length = 0.0; ///< relaxation length σ, m
  double tread_damping = 0.0;     ///< tread damping b, N s/m
};

[[nodiscard]] const ElementKind& tyre_kind();

} // namespace steplap
