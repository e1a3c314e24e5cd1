// Criteria that a kind of element applies to every run: the result of ElementKind::judge, and helpers.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Judgement of one element after a run.
struct ElementJudgement {
  std::vector<CriterionResult> criteria; ///< may be none
  std::vector<std::string> caps;         ///< why the run cannot mean "hold" (Judgement::caps)
  std::string distrust;                  ///< not empty: reason why the result of this element is impossible and the run cannot be trusted
};

/// Returns the range of a channel, or nullptr if the run has none.
[[nodiscard]] const ChannelRange* find_range(const RunResult& result, const std::string& channel);
/// Returns the number as text, without an exponent if that is shorter: "300000", not "3e+05".
[[nodiscard]] std::string limit_text(double value);
/// Returns advice on a smaller step or tolerance, or another method: "try a tolerance of 1e-10, or the integrator rodas5p".
[[nodiscard]] std::string remedy(const SimulationSettings& settings);

} // namespace steplap
