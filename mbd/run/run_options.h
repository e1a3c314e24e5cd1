// Options of a run and of its evaluation. Method, step, tolerance, end and output step are normally those of the model ([simulation],
// [output]). Values given here are written into the model before it is run (with_settings.h), so that results record the settings with
// which they were made.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/system/system.h"

#include <functional>
#include <optional>
#include <string>

namespace steplap {

/// When the errors of a run are estimated.
enum class Estimating {
  never, ///< never: criteria are judged as if the numbers were exact
  cheap, ///< if the finer runs cost about a second or less, ten if a "hold" depends on them, measured in evaluations, not in time
  always ///< always, at any cost
};

/// Settings that replace those of the model file, and settings that no model file contains.
struct RunOptions {
  std::optional<std::string> method;         ///< replaces `integrator` of [simulation]: "auto", "dop853" (mbd/model/method.h)
  std::optional<double> tolerance;           ///< replaces `tolerance` of [simulation]: relative, per step of an adaptive method
  std::optional<double> step;                ///< replaces `step` of [simulation], s: for methods with constant step only
  std::optional<double> end;                 ///< replaces `end` of [simulation], s
  std::optional<double> output_step;         ///< replaces `step` of [output], s
  bool has_extremes = true;                  ///< false: extremes are not computed, nothing is judged, and the verdict is open
  std::optional<State> start;                ///< initial state; the model's own if not given
  Estimating estimating = Estimating::cheap; ///< when errors are estimated
  bool has_second_opinion = false;           ///< true: a "hold" is checked by a second method (second_opinion.h)
  std::function<void(double t)> progress;    ///< called at every step with the time, s
  std::function<std::string()> stop;         ///< called at every step; a text other than "" ends the run and becomes the reason
  std::function<void(const Finding&)> note;  ///< called for each finding as soon as it is found
};

} // namespace steplap
