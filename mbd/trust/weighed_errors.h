// Takes the errors of a run's numbers (mbd/trust/global_error.h) into account in its judgement.
//
// A criterion that is met, but whose limit lies within the error, becomes *open*: a run at a smaller tolerance or step decides. It does not
// mean "inspect", since no fault is known. A criterion also becomes open if its error is unknown or if a finer run does not meet it. A
// criterion that is not met stays so, even if the limit lies within the error; this is reported in `doubt`.
#pragma once

#include "mbd/model/model.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judgement.h"

namespace steplap {

/// Sets the error of every criterion, and opens those that are met only within their error. Also sets Judgement::distrust if the motion is
/// known to less than a tenth of its range, or if an element slips in the run and sticks in the finer run, or the reverse, and a verdict or
/// a tenth of a slid distance depends on that.
void weigh_errors(Judgement& judgement, const Model& model, const System& system, const RunResult& run,
                  const GlobalErrorEstimate& estimate);
/// Opens all criteria that are met, because the error of the run could not be estimated.
void leave_open(Judgement& judgement, const std::string& why);

/// Returns the errors of the channel with this name; nullptr if there is no such channel.
[[nodiscard]] const ChannelError* find_error(const std::string& channel, const System& system, const GlobalErrorEstimate& estimate);
/// Returns the error of the time of the element's event at exactly `t`, s; nothing if there is no such event.
[[nodiscard]] std::optional<double> event_error(const std::string& element, double t, const RunResult& run,
                                                const GlobalErrorEstimate& estimate);

} // namespace steplap
