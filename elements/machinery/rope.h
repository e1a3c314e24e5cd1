// Rope: tension only, from marker a over any number of others to marker b.
//
// Its length is the way over its points, L = Σ |p_{i+1} − p_i|; a point that it runs over is a pulley without size or
// friction, fixed in its body, so that the tension is the same all along:
//   T = max(0, k (L − L₀) + c L̇) while L > L₀, else 0.
// Each straight part pulls its two points towards each other with T. Potential ½ k (L − L₀)²; the damper dissipates
// T L̇ less the change of that. Points keep their order, whether or not the rope would leave a pulley. What is pulled up
// to its pulley ends the run, with a word (mbd/system/rope_end.h).
//
// An inextensible rope is a row that comes and goes (mbd/system/one_sided_row.h): L ≤ L₀, T ≥ 0, T (L₀ − L) = 0. It
// becomes taut by a blow without restitution (mbd/events/blow.h). Straight parts within one body only add to its
// length; those between different ones are the row's parts (RowSpec::next), all with the same tension.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Rope : Element {
  std::string a, b = "ground";
  std::vector<std::string> over; ///< markers between its ends, in order
  std::optional<double> stiffness;
  bool inextensible = false;
  double damping = 0.0;
  std::optional<double> length;     ///< without load
  std::optional<double> pretension; ///< in the reference pose
  std::optional<double> slack;      ///< in the reference pose: length less the way
};

[[nodiscard]] const ElementKind& rope_kind();

} // namespace steplap
