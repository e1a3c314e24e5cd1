// How a model is run and what is found out about it. Method, step, tolerance, end and output step are the model's own
// ([simulation], [output]) unless they are given here: then they are laid over the model before it is run (with_settings.h), so that
// results say what they were made with.
#pragma once

#include "mbd/system/system.h"
#include "run/finding.h"

#include <functional>
#include <optional>
#include <string>

namespace steplap {

/// When the errors of a run are estimated.
enum class Estimating {
  never, ///< not at all: criteria are then judged as if their numbers were exact
  cheap, ///< where finer runs cost a second or so: counted in evaluations, not timed
  always ///< whatever it costs
};

/// How a model is run: what its file does not say, and what is to be other than it says.
struct RunOptions {
  std::optional<std::string> method;         ///< instead of `integrator` of [simulation]: "auto", "dop853" (mbd/model/method.h)
  std::optional<double> tolerance;           ///< instead of that of [simulation]: relative, of each step of an adaptive method
  std::optional<double> step;                ///< instead of that of [simulation], s: for methods of a fixed step only
  std::optional<double> end;                 ///< instead of that of [simulation], s
  std::optional<double> output_step;         ///< instead of `step` of [output], s
  bool has_extremes = true;                  ///< without them nothing is judged: the verdict is open
  std::optional<State> start;                ///< where the run begins; the model's own start if not given
  Estimating estimating = Estimating::cheap; ///< when errors are estimated
  bool has_second_opinion = false;           ///< for a verdict that holds (second_opinion.h)
  std::function<void(double t)> progress;    ///< called at every step with its time, s
  std::function<std::string()> stop;         ///< asked at every step; what it says is why the run ends there, "" lets it go on
  std::function<void(const Finding&)> note;  ///< told of each finding when it is found
};

} // namespace steplap
