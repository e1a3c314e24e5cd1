// How steps pass singular positions of joints (a parallelogram that folds flat).
//
// Accelerations near them are known to rounding over the square of the distance, so no stage may come too
// close. A step that fails for that is tried again a little shorter, until the position lies in a gap between
// its stages; and no step ends closer than a hundredth of a radian if it need not.
#pragma once

#include "mbd/dynamics/dynamics.h"

namespace steplap {

class SingularPassage {
public:
  /// At the start of a step, the last evaluation still at its state.
  explicit SingularPassage(Dynamics& dynamics) : dynamics_(dynamics), begins_near_(is_near()) {}

  /// Before each try.
  void begin_try() { dynamics_.forget_pivots(); }
  /// After a try that would be accepted: should it end elsewhere?
  [[nodiscard]] bool wants_other_end() { return !begins_near_ && other_ends_ < k_max_other_ends && is_near() && ++other_ends_ > 0; }
  /// After one that would not: because a stage came too close?
  [[nodiscard]] bool wants_other_stages() {
    return dynamics_.lowest_pivot() < k_close_pivot && tries_across_ < k_max_tries_across && ++tries_across_ > 0;
  }

  static constexpr double k_shorter_end = 0.75, k_shorter_across = 0.88;

private:
  [[nodiscard]] bool is_near() const { return !dynamics_.layout().active.empty() && dynamics_.smallest_pivot() < k_end_pivot; }

  // Squares of distances, rad².
  static constexpr double k_close_pivot = 1e-3, k_end_pivot = 1e-4;
  static constexpr int k_max_tries_across = 14, k_max_other_ends = 3;

  Dynamics& dynamics_;
  bool begins_near_;
  int other_ends_ = 0, tries_across_ = 0;
};

} // namespace steplap
