// Static equilibrium of a machine whose loads have grown slowly from those that it rested under.
//
// find_equilibrium (equilibrium.h) asks whether a machine can rest: friction between bodies may then share the load in any way that
// it can bear. A load that grows slowly leaves no such choice: friction that holds keeps holding where it is, and slides at its bound
// as soon as that is reached. So this search neither shares a load anew nor lets a damped machine settle: it fails where the
// machine would leave its rest.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"

namespace steplap {

/// The search for a rest came to no end: whether there is one is not known.
class RestNotFound : public ElementFailure {
public:
  using ElementFailure::ElementFailure;
};

/// From `start`, a rest under other loads. Throws NumericalFailure where none is found without leaving it.
[[nodiscard]] Equilibrium find_ramped_rest(const System& system, const State& start);

} // namespace steplap
