// What a kind of element asks of every run, by itself: ElementKind::judge.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// What a kind of element says of one of its elements after a run.
struct ElementJudgement {
  std::vector<CriterionResult> criteria; ///< may be none
  std::vector<std::string> caps;         ///< why the run cannot mean "hold" (Judgement::caps)
  std::string distrust;                  ///< not empty: the run says of the element what cannot be
};

/// The range of a channel, or nullptr if the run has none.
[[nodiscard]] const ChannelRange* find_range(const RunResult& result, const std::string& channel);
/// Without an exponent where that is shorter to read: "300000", not "3e+05".
[[nodiscard]] std::string limit_text(double value);
/// Which smaller step or tolerance, or which other method, to try: "try a tolerance of 1e-10, or the integrator rodas5p".
[[nodiscard]] std::string remedy(const SimulationSettings& settings);

} // namespace steplap
