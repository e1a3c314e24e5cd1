// Tie: what bears beside a joint. Tie (flitch) plates, clamping bolts, bindings, resin, a winding round a limb: a
// spring between two markers that pulls, presses or both, with slack, preload and a strength at which it breaks for
// good.
//
// Elongation δ = measure − free length (along an axis fixed in body b, or from point to point). Beyond the slack on a
// side on which it acts f = −k (δ ∓ slack) − c δ̇ on a along the measure's gradient, never pushing where it pulls (as
// unilateral_contact does, with its modes). |f| reaching `strength` is an event, "breaks": from then on it gives no
// force, and what it had stored is dissipated. Assumes a straight characteristic up to the strength: no yielding of
// steel.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Tie : Element {
  std::string a, b = "ground";
  std::optional<Vec2> axis;     ///< in marker b's axes; absent: point to point
  std::string acts = "tension"; ///< "tension", "compression", "both"
  double stiffness = 0.0, damping = 0.0;
  double slack = 0.0;                 ///< m, on each side on which it acts, before it does
  std::optional<double> preload;      ///< N, tension positive, of all in the reference pose
  std::optional<double> strength;     ///< N, of one
  std::string on_break = "continue";  ///< or "stop"
  std::string consequence = "reject"; ///< of its breaking, for the verdict: "reject", "inspect", or "none": it is meant to go first
  long count = 1;
};

[[nodiscard]] const ElementKind& tie_kind();

} // namespace steplap
