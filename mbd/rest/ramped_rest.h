// Static equilibrium of a machine at rest whose loads have increased slowly. find_equilibrium (equilibrium.h) asks whether a machine can
// rest with any admissible distribution of friction forces. Under a slowly growing load the distribution is determined: sticking friction
// holds its position and slides at its bound once that is reached. So this search neither redistributes forces nor releases a damped
// machine. It fails if the machine would leave its equilibrium.
#pragma once

#include "mbd/rest/equilibrium.h"
#include "mbd/system/element_failure.h"

namespace steplap {

/// Error: the search did not converge, so it is unknown whether an equilibrium exists.
class RestNotFound : public ElementFailure {
public:
  using ElementFailure::ElementFailure;
};

/// Returns the equilibrium reached from `start`, an equilibrium under other loads. Throws NumericalFailure if the machine would leave it,
/// RestNotFound if the search does not converge.
[[nodiscard]] Equilibrium find_ramped_rest(const System& system, const State& start);

} // namespace steplap
