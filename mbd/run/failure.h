// Describes why a run, or the search for its initial state, ended early, with the elements concerned and their positions in the model file.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/base/stop.h"
#include "mbd/model/model.h"
#include "mbd/system/system.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Kind of failure that ended a run early.
enum class FailureKind {
  numerical, ///< the computation could not continue
  stopped    ///< stopped by the user
};

/// An element or a body at which a run failed.
struct FailedElement {
  std::string name; ///< name of the element or body
  Location where;   ///< position in the model file; line 0 if unknown
};

/// Reason why a run ended early.
struct Failure {
  FailureKind kind = FailureKind::numerical; ///< kind of failure
  std::string text;                          ///< message with time and advice, and with file and line of the elements
  double t = 0.0;                            ///< time at which the run ended, s
  std::vector<FailedElement> elements;       ///< most likely cause first
};

/// Converts an exception into a Failure. `t` is the time that the run has reached, s.
[[nodiscard]] Failure failure_of(const NumericalFailure& failure, const Model& model, const System& system, double t);
/// If a formula of a force or state has no finite value immediately after `last`, or within a fixed step (0: steps are adaptive), returns the
/// failure that names its element.
[[nodiscard]] std::optional<Failure> formula_failure(const State& last, double step, const Model& model, const System& system);

} // namespace steplap
