// Data that a step-lap joint keeps between evaluations, for step_lap_friction.cpp and step_lap_slip.cpp.
#pragma once

#include "elements/step_lap/step_lap_friction.h"

#include <algorithm>
#include <optional>

namespace steplap {

// Smallest times, s, down to which the onset and the end of a slip are resolved (step_lap_slip.cpp).
inline constexpr double k_onset_time = 5e-8, k_end_time = 1e-11;

/// Returns the traction, N/m², of a pair of sheets at the point where its linear pressure has the value given in the interface.
[[nodiscard]] inline double traction_of(const SheetPair& s, GripLaw law, double tilt) {
  const double pressed = s.transverse == 0.0 ? 1.0 : std::max(0.0, 1.0 + s.transverse * tilt);
  return pressed * (law == GripLaw::holding ? s.static_traction : s.kinetic_traction);
}

struct StepLapFriction::Fit {
  Patch patch; ///< overlap area with the tractions for pressure factor 1
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

  /// Returns the patch prepared with expansions (Patch::prepare), for callers that evaluate it often; many joints never need it. It is a
  /// separate copy, because expansions sum in another order, and results from `patch` must not depend on whether the copy exists.
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

/// Arguments of a flow evaluation, compared to reuse the last result.
struct StepLapFriction::FlowQuestion {
  Vec3 slid, force, direction, rate;
  PressureState pressure;
  [[nodiscard]] bool operator==(const FlowQuestion&) const = default;
};

struct StepLapFriction::Scratch final : FrictionScratch {
  OverlapWorkspace workspace;
  Region region;
  Fit fits[2];
  Patch spare;
  Vec3 asked = Vec3::Zero(); ///< wrench of the last usage() at the pose usage_pose
  Pose usage_pose;
  bool was_from_table = false;    ///< result of the last usage() came from the prepared patch
  bool was_from_slip_law = false; ///< result of the last usage() came from the slip law
  RequiredPressure answer;
  PressureState pressed;                                   ///< pressures at the last usage()
  double onset_time = k_onset_time, end_time = k_end_time; ///< times to which onset and end of slip are resolved, s
  OverlapLoss lost;                                        ///< loss at the pose lost_at
  Pose lost_at;
  bool is_lost_known = false;
  std::optional<FlowQuestion> last_flow_question; ///< arguments of the last flow evaluation
  Flow flow_answer;

  void follow(double tolerance) override;
};

} // namespace steplap
