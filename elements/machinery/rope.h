// Rope: tension only, from marker a over any number of other markers to marker b.
//
// Its length is the sum of its straight parts, L = Σ |p_{i+1} − p_i|. Intermediate points are pulleys without size and friction, fixed to
// their bodies, so that the tension is the same in all parts:
//
//   T = max(0, k (L − L₀) + c L̇) while L > L₀, otherwise 0.
//
// With `across` a rope of one part has L = √(l² + c²), l being the distance in the plane (space_distance.h). `count` equal ropes act together;
// T is that of one.
//
// Each part pulls its two points towards each other with T. Potential energy ½ k (L − L₀)²; the damper dissipates T L̇ minus the change of
// this energy. The order of the points is fixed, even if a real rope would leave a pulley. If a load reaches its pulley the run ends with
// an error (mbd/system/rope_end.h).
//
// An inextensible rope is a unilateral constraint (mbd/system/one_sided_row.h): L ≤ L₀, T ≥ 0, T (L₀ − L) = 0. It becomes taut by an
// impulse without restitution (mbd/events/blow.h). Straight parts within one body only add to the length; those between different bodies
// are the parts of the row (RowSpec::next), with the same tension.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Rope : Element {
  std::string a, b = "ground";
  std::vector<std::string> over; ///< names of the markers between the ends, in order
  double across = 0.0;           ///< distance of its ends across the plane, m
  long count = 1;                ///< number of equal ropes
  std::optional<double> stiffness;
  bool inextensible = false;
  double damping = 0.0;
  std::optional<double> length;     ///< length without load, m
  std::optional<double> pretension; ///< tension in the reference pose, N
  std::optional<double> slack;      ///< length minus distance along the points in the reference pose, m
};

[[nodiscard]] const ElementKind& rope_kind();

} // namespace steplap
