// Why a run, or the search for its start, ended before its end: with the elements it happened at and where these stand.
#pragma once

#include "mbd/base/diagnostics.h"
#include "mbd/model/model.h"
#include "mbd/system/system.h"

#include <string>
#include <vector>

namespace steplap {

/// Somebody asked the run to stop (RunOptions::stop).
class RunStopped : public NumericalFailure {
public:
  /// The message.
  using NumericalFailure::NumericalFailure;
};

/// Why a run ended before its end.
enum class FailureKind {
  numerical, ///< the computation could not go on
  stopped    ///< somebody asked it to
};

/// An element or a body at which a run failed.
struct FailedElement {
  std::string name; ///< of an element or a body
  Location where;   ///< line 0: of no file
};

/// What stopped a run.
struct Failure {
  FailureKind kind = FailureKind::numerical; ///< why it ended
  std::string text;                          ///< with time and advice, and with file and line of the elements
  double t = 0.0;                            ///< s, how far the run came
  std::vector<FailedElement> elements;       ///< the worst first
};

/// `t`: how far the run came, s.
[[nodiscard]] Failure failure_of(const NumericalFailure& failure, const Model& model, const System& system, double t);

} // namespace steplap
