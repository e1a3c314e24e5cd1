// Data that a step-lap joint keeps between evaluations, for step_lap_friction.cpp and step_lap_slip.cpp.
#pragma once

#include "elements/step_lap/step_lap_friction.h"
#include "mbd/system/slip_scratch.h"

#include <algorithm>
#include <optional>

namespace steplap {

// Smallest times, s, down to which the onset and the end of a slip are resolved (step_lap_slip.cpp).
inline constexpr double k_onset_time = 5e-8, k_end_time = 1e-11;

/// Returns the traction of a pair of sheets at the point where its linear pressure has the value given in the interface.
[[nodiscard]] inline double traction_of(const SheetPair& s, GripLaw law, double tilt) {
  const double pressed = s.transverse == 0.0 ? 1.0 : std::max(0.0, 1.0 + s.transverse * tilt);
  return pressed * (law == GripLaw::holding ? s.static_traction : s.kinetic_traction);
}

struct StepLapFriction::Fit {
  Patch patch; ///< for pressure factor 1
  Pose pose;
  double tilt = 0.0;
  Capacity capacity;
  bool is_valid = false, has_capacity = false;

  /// Computes the capacity once for a joint that stays at its pose.
  void prepare() {
    if (has_capacity || patch.empty()) return;
    capacity = steplap::capacity(patch);
    has_capacity = true;
  }

  /// Returns the patch with a table, for callers that need more than the bounds by the capacity; many joints that hold never do. It is a
  /// separate copy, since with a table sums are computed in another order, and results from `patch` must not depend on whether the table
  /// exists.
  const Patch& tabulated() {
    if (has_table) return table;
    table = patch;
    table.prepare();
    has_table = true;
    return table;
  }

  Patch table; ///< prepared copy of `patch`
  bool has_table = false;
};

/// All arguments of a flow.
struct StepLapFriction::FlowQuestion {
  Vec3 slid, force, direction, rate;
  PressureState pressure;
  [[nodiscard]] bool operator==(const FlowQuestion&) const = default;
};

struct StepLapFriction::Scratch final : SlipScratch {
  OverlapWorkspace workspace;
  Region region;
  Fit fits[2];
  Patch spare;
  Vec3 asked = Vec3::Zero(); ///< wrench of the last usage() at this pose
  Pose asked_at;
  bool was_stuck = false; ///< its result came from the table
  bool was_known = false; ///< its result came from the slip law
  RequiredPressure answer;
  PressureState pressed;                                   ///< pressures at the last usage()
  double onset_time = k_onset_time, end_time = k_end_time; ///< s, resolution of onset and end of slip
  OverlapLoss lost;                                        ///< at this pose
  Pose lost_at;
  bool is_lost_known = false;
  std::optional<FlowQuestion> flow_asked; ///< arguments of the last flow
  Flow flow_answer;

  void follow(double tolerance) override;
};

} // namespace steplap
