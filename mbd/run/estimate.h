// Estimates the numerical errors of a run from finer runs (mbd/trust/global_error.h), unless these are too expensive.
#pragma once

#include "mbd/run/run.h"
#include "mbd/trust/balance.h"
#include "mbd/trust/global_error.h"

namespace steplap {

/// Result of the attempt to estimate the errors of a run.
enum class EstimateStatus {
  known,         ///< `errors` is available
  left_out,      ///< not requested, or the run did not reach its end
  too_expensive, ///< not forced, and the finer runs would take too long
  failed         ///< a finer run could not be completed
};

/// The errors of a run, or the reason why they are unknown.
struct Estimate {
  EstimateStatus status = EstimateStatus::left_out; ///< whether `errors` is available
  std::string reason;                               ///< reason if there is no estimate
  std::optional<double> cost;                       ///< predicted computing time, s, if the finer runs were not started because of it
  std::optional<GlobalErrorEstimate> errors;        ///< set if status is `known`
  std::optional<UnstableBody> balance = {};         ///< set if errors are known and the machine is in an unstable equilibrium
  std::string balance_unknown = {};                 ///< reason if stability could not be determined; empty otherwise
};

/// Estimates the errors of `run`. The cost of finer runs is measured in operations, not in time: verdicts depend on the errors and must not
/// depend on the speed or load of the computer. `is_decisive`: the verdict is "hold" unless the errors say otherwise. Such an estimate may
/// cost ten times as much, and any amount if the hold is also checked by a second method.
[[nodiscard]] Estimate estimate_errors(const Run& run, const RunOptions& options, bool is_decisive);

} // namespace steplap
