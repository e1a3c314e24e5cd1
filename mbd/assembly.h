// Assembly: do the poses that the file gives meet the joints, up to a least motion?
//
// A model may give its poses roughly: the first projection of a run moves the bodies onto their joints.
// Joints that no motion can meet are an error of the model, found before anything runs.
#pragma once

#include "mbd/model.h"
#include "mbd/system.h"

namespace steplap {

/// The initial state moved onto the constraints (mass-weighted least motion), drives begun there.
/// Throws ModelError at the element that stays unmet most; `model` is what `system` was compiled from.
[[nodiscard]] State assemble(const Model& model, const System& system);

} // namespace steplap
