// Wheel with a tyre on a road, seen from the side: it presses, lifts off, grips, slips and locks.
//
// Body a is the wheel, its marker the centre; the road y = h(x) is flat or a smooth curve (road.h) in the axes of marker b. With d the
// distance of the centre from the road, n the road's normal at the nearest place and t = −ẑ×n its direction:
//   normal force N = max(0, k (r − d) − c ḋ), along n, through the centre;
//   slip rate v_s = t·v + r ω, the velocity of the tread's ground against the road (ω against b; rolling forward ω < 0);
//   the tread passes through the contact with V = |r ω|.
// Bristles between tread and road are bent by u, on average over the contact:
//   adhering     u̇ = v_s − V u/σ,  T = C/σ u + b u̇,   valid while |T| ≤ μ N
//   sliding      T = ±μ N,         u̇ = (T − C/σ u)/b,  valid while it would take more to adhere
// and T acts on the wheel against v_s. σ is the relaxation length: bristles that leave the contact are replaced by straight ones. So at
// standstill (V = 0) the tread is a spring C/σ beside a damper b that holds exactly up to μ N; at steady rolling T = C v_s/V up to μ N,
// the slip stiffness C times the slip; after a step of slip T approaches that over the way σ. (H. B. Pacejka, Tyre and Vehicle
// Dynamics, 3rd ed. 2012, ch. 7: the linear single-point model, here with a bound and with V of the tread instead of the axle, as
// bristles have it: those of a locked wheel stay.) With μ N reached at the slip μ N/C the curve has a corner where that of a
// measured tyre is round.
//
// Stored: ½ k (r − d)² and ½ C/σ u². The bristles dissipate b (u̇ + V u/2σ)² + (4 C − b V) V u²/4σ², so that with V > 4 C/b they would drive: beyond it b is 4 C/V.
// The wheel's radius counts for rolling as for touching, so that T has the arm r: it acts below the road's surface by what the tyre is
// pressed in.
// Valid for roads whose hollows are less curved than the wheel (checked), and penetrations that are small against both.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

struct Tyre : Element {
  std::string a, b = "ground";
  double radius = 0.0;            ///< m
  std::vector<Vec2> road;         ///< (x, height), m, in marker b's axes; empty: flat
  double stiffness = 0.0;         ///< N/m
  double damping = 0.0;           ///< N s/m
  double friction = 0.0;          ///< μ
  double slip_stiffness = 0.0;    ///< C, N for a slip of 1
  double relaxation_length = 0.0; ///< σ, m
  double tread_damping = 0.0;     ///< b, N s/m
};

[[nodiscard]] const ElementKind& tyre_kind();

} // namespace steplap
