// Static equilibrium of a machine at rest whose loads have grown slowly.
//
// find_equilibrium() (equilibrium.h) accepts any admissible distribution of friction forces. Under slowly growing loads the distribution is
// determined: sticking friction keeps its position, and slides at its bound once that is reached. This search therefore neither
// redistributes friction forces nor releases a damped machine. It fails if the machine would leave its equilibrium.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"

namespace steplap {

/// Error of a search that did not converge, so that it is unknown whether an equilibrium exists.
class RestNotFound : public ElementFailure {
public:
  using ElementFailure::ElementFailure;
};

/// Returns the equilibrium reached from `start`, an equilibrium under other loads. Throws NumericalFailure if the machine would leave it,
/// RestNotFound if the search does not converge.
[[nodiscard]] Equilibrium find_ramped_rest(const System& system, const State& start);

} // namespace steplap
