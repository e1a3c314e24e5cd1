// Tie: carries load in parallel with a joint. For tie (flitch) plates, clamping bolts, bindings, resin, or a winding around a limb: a
// spring between two markers that acts in tension, compression or both, with slack, preload, and a strength at which it breaks permanently.
//
// Elongation δ = measure − free length (along an axis fixed in body b, or from point to point). Beyond the slack, on a side on which it
// acts, f = −k (δ ∓ slack) − c δ̇ on a along the gradient of the measure. A tension tie does not push, and a compression tie does not pull
// (the modes are those of unilateral_contact). When |f| reaches `strength` the event "breaks" occurs: the force is zero from then on, and
// the stored energy is dissipated. Assumption: linear up to the strength, without yielding.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Tie : Element {
  std::string a, b = "ground";
  std::optional<Vec2> axis;     ///< direction of the tie in marker b's axes; not given: the line between the markers
  double across = 0.0;          ///< distance of its ends across the plane, m
  std::string acts = "tension"; ///< sides on which it acts: "tension", "compression", "both"
  double stiffness = 0.0, damping = 0.0;
  double slack = 0.0;                ///< free travel on each side on which it acts, m
  std::optional<double> preload;     ///< total preload in the reference pose, N, tension positive
  std::optional<double> strength;    ///< strength of one tie, N
  std::string on_break = "continue"; ///< "continue" or "stop": what the run does when the tie breaks
  /// Consequence of breaking for the verdict: "reject", "inspect", or "none" for a predetermined breaking point.
  std::string consequence = "reject";
  long count = 1;
};

[[nodiscard]] const ElementKind& tie_kind();

} // namespace steplap
