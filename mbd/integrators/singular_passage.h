// Policy for passing singular positions of joints (for example a parallelogram that folds flat) by ordinary steps.
//
// The rounding error of accelerations grows with the inverse square of the distance from such a position, so no stage may be too close
// to it. A step that fails for this reason is repeated slightly shorter, until the position lies between two stages. Steps also avoid
// ending within 0.01 rad of the position.
#pragma once

#include "mbd/dynamics/dynamics.h"

namespace steplap {

/// Decisions about one step near a singular position.
class SingularPassage {
public:
  /// To be created at the start of a step, with the last evaluation at its state.
  explicit SingularPassage(Dynamics& dynamics) : dynamics_(dynamics), begins_near_(is_near()) {}

  /// To be called before each attempt.
  void begin_try() { dynamics_.reset_least_pivot(); }
  /// To be called after an acceptable attempt: returns true if the step should end elsewhere, because its end is too near the singular
  /// position.
  [[nodiscard]] bool needs_other_end() { return !begins_near_ && other_ends_ < k_max_other_ends && is_near() && ++other_ends_ > 0; }
  /// To be called after a rejected attempt: returns true if it should be repeated, because a stage came too near the singular position.
  [[nodiscard]] bool needs_other_stages() {
    return dynamics_.least_pivot() < k_close_pivot && tries_across_ < k_max_tries_across && ++tries_across_ > 0;
  }

  static constexpr double k_shorter_end = 0.75, k_shorter_across = 0.88;

private:
  [[nodiscard]] bool is_near() const { return !dynamics_.layout().active.empty() && dynamics_.smallest_pivot() < k_end_pivot; }

  // Limits for stages and for the end of a step, as pivots of the constraints: about the square of the distance from the singular
  // position, rad².
  static constexpr double k_close_pivot = 1e-3, k_end_pivot = 1e-4;
  static constexpr int k_max_tries_across = 14, k_max_other_ends = 3;

  Dynamics& dynamics_;
  bool begins_near_;
  int other_ends_ = 0, tries_across_ = 0;
};

} // namespace steplap
