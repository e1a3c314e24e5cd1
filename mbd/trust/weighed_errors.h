// A judgement weighed by the errors of its numbers (mbd/trust/global_error.h): what a criterion is worth whose value is known
// to so many digits only.
//
// A criterion that is met, but whose error reaches the limit, is not: nor is it one to inspect the machine for, since
// nothing is known to be wrong with it. It is *open*, and a run at a smaller tolerance or step decides. The same goes
// for one whose error is unknown, and for one that a finer run does not meet. A criterion that is not met stays so,
// even where the error reaches back to the limit: that is said beside it.
#pragma once

#include "mbd/model/model.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Gives every criterion its error, and takes back those that are met within it only. A run whose motion is known to
/// less than a tenth of its range is not to be trusted, nor one in which something slips that holds in the finer run, or
/// the other way round, where a verdict or a tenth of a slid distance depends on it.
void weigh_errors(Judgement& judgement, const Model& model, const System& system, const RunResult& run,
                  const GlobalErrorEstimate& estimate);
/// Of a run whose error should have been estimated and could not: no criterion can be called met.
void leave_open(Judgement& judgement, const std::string& why);

/// The error of a channel by its name; nullptr if there is no such channel.
[[nodiscard]] const ChannelError* find_error(const std::string& channel, const System& system, const GlobalErrorEstimate& estimate);
/// The error of the time, s, of an event of the element at exactly `t`; empty if there is none.
[[nodiscard]] std::optional<double> event_error(const std::string& element, double t, const RunResult& run,
                                                const GlobalErrorEstimate& estimate);

} // namespace steplap
