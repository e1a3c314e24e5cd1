// Checks a run by a second method that has little in common with the first. Requested for verdicts that must be reliable.
//
// A run is compared with moreau, which locates no events; a run by moreau is compared with dop853. Both methods run with two or three
// settings and are compared as in `steplap check --cross` (mbd/trust/cross_check.h): every channel, event and energy must agree within the
// error estimates of both. The limit on computing time is measured in evaluations, because an exit code depends on it.
//
// If time stepping cannot run the scene or is too coarse for it, the second run uses an event-locating method with other steps: a third of
// the mean step of the first run at most, times a pseudo-random number between 0.5 and 1.5. It uses the same event search and interpolation
// as the first run, but samples event functions at other times and so can find an event that the first run missed.
#pragma once

#include "mbd/run/run.h"

#include <string>

namespace steplap {

/// Result of the second method, or the reason why there is none.
struct SecondOpinion {
  std::string method;       ///< method with its step or tolerance: "moreau@0.0005"
  double drawn_step = 0.0;  ///< mean of the random steps, s; 0 if the method has its own steps
  std::string none_because; ///< reason why there is no result; empty if there is one
  std::string disagreement; ///< difference that exceeds both errors; empty if there is none
  double worst_ratio = 0.0; ///< largest ratio of a difference to the one that both errors permit
  double known_until = 0.0; ///< time from which the second method is too coarse to compare, s

  /// Returns true if the methods were compared up to `end`, s: the last row of both may lie a little before it.
  [[nodiscard]] bool reaches(double end) const { return none_because.empty() && known_until >= end * (1.0 - 1e-6); }
};

/// Checks `run` by a second method. `is_alone`: nothing else checks the run, so if time stepping can be compared only up to some time, the
/// random steps are tried, too. Precondition: `run` reached its end and was made with `options`.
[[nodiscard]] SecondOpinion second_opinion(const Run& run, const RunOptions& options, bool is_alone);

} // namespace steplap
