// Result of ElementKind::judge, by which a kind of element applies its own criteria to every run, and helper functions.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Judgement on one element after a run.
struct ElementJudgement {
  std::vector<CriterionResult> criteria; ///< may be none
  std::vector<std::string> caps;         ///< why the run cannot mean "hold" (Judgement::caps)
  std::string distrust;                  ///< reason why the element's result is impossible and the run cannot be trusted; "": none
};

/// Returns the range of a channel, or nullptr if the run has none.
[[nodiscard]] const ChannelRange* find_range(const RunResult& result, const std::string& channel);
/// Returns the number as text, without an exponent if that is shorter: "300000", not "3e+05".
[[nodiscard]] std::string limit_text(double value);
/// Returns advice on a smaller step or tolerance, or another method: "try a tolerance of 1e-10, or the integrator rodas5p".
[[nodiscard]] std::string remedy(const SimulationSettings& settings);

} // namespace steplap
