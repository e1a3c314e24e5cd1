// How far the numbers of a run are known: from finer runs (mbd/trust/global_error.h), where these are worth their cost.
#pragma once

#include "mbd/trust/balance.h"
#include "mbd/trust/global_error.h"
#include "run/run.h"

namespace steplap {

/// Whether the errors of a run are known.
enum class EstimateStatus {
  known,    ///< `errors` is there
  left_out, ///< not asked for, or the run broke off
  too_dear, ///< nobody insisted, and finer runs would take long
  failed    ///< a finer run could not be finished
};

/// The errors of a run, or why they are not known.
struct Estimate {
  EstimateStatus status = EstimateStatus::left_out; ///< whether they are known
  std::string reason;                               ///< why there is none
  std::optional<double> cost;                       ///< s of computing that it would take, where it was not begun for that
  std::optional<GlobalErrorEstimate> errors;        ///< if known
  std::optional<Balance> balance = {};              ///< if the machine stays where it is only as nothing disturbs it, and errors are known
  std::string balance_unknown = {};                 ///< why it was not found out whether it does; empty: it was
};

/// Cheap is counted in work, not in time: criteria are judged by the errors, and a verdict may not hang on how fast or how busy
/// the computer is.
[[nodiscard]] Estimate estimate_errors(const Run& run, const RunOptions& options);

} // namespace steplap
