// What a method that shares little with the one used makes of the same run: asked for where a verdict has to hold.
//
// Beside moreau, which locates no events, stands the method that was used; a run by moreau is compared with dop853. Both are
// made at two or three settings and compared as `steplap check --cross` does (mbd/trust/cross_check.h): every channel,
// event and energy, beyond the errors that both methods tell of themselves. Whether it had time is counted in evaluations,
// not seconds, for an exit code hangs on it.
//
// Where time stepping cannot run the scene, or is too coarse for it, a method that locates events is asked instead, whose steps are
// others: at most a third of the mean step of the run, times a pseudo-random number between 0.5 and 1.5. The search for events and the
// polynomials are then the same, but what passes between two looks of the one run is met by the other.
#pragma once

#include "run/run.h"

#include <string>

namespace steplap {

/// What the other method said, or why it said nothing.
struct SecondOpinion {
  std::string method;       ///< with its step or tolerance: "moreau@0.0005"
  double drawn_step = 0.0;  ///< s: mean of the steps that were drawn for it; 0: it had steps of its own
  std::string none_because; ///< not empty: it has no opinion, and why
  std::string disagreement; ///< not empty: what differs by more than both errors
  double worst_ratio = 0.0; ///< of differences over what the errors allow
  double known_until = 0.0; ///< s: from there on it is too coarse to tell
};

/// `run` reached its end; it was made with `options`.
[[nodiscard]] SecondOpinion second_opinion(const Run& run, const RunOptions& options);

} // namespace steplap
