// What a step-lap joint keeps between evaluations, for step_lap_friction.cpp and step_lap_slip.cpp.
#pragma once

#include "elements/step_lap/step_lap_friction.h"
#include "mbd/system/slip_scratch.h"

#include <algorithm>
#include <optional>

namespace steplap {

// The least times that a slip's onset and end are followed down to, s (step_lap_slip.cpp).
inline constexpr double k_onset_time = 5e-8, k_end_time = 1e-11;

/// Of a pair of sheets where its linear pressure is what its interface says.
[[nodiscard]] inline double traction_of(const SheetPair& s, GripLaw law, double tilt) {
  const double pressed = s.transverse == 0.0 ? 1.0 : std::max(0.0, 1.0 + s.transverse * tilt);
  return pressed * (law == GripLaw::holding ? s.static_traction : s.kinetic_traction);
}

struct StepLapFriction::Fit {
  Patch patch; ///< at a pressure factor of 1
  Pose pose;
  double tilt = 0.0;
  Capacity capacity;
  bool is_valid = false, has_capacity = false;

  /// What a joint that stays at its pose is asked many times.
  void prepare() {
    if (has_capacity || patch.empty()) return;
    capacity = steplap::capacity(patch);
    has_capacity = true;
  }

  /// For whoever the bounds by the capacity do not satisfy: many a joint that holds never comes to that. A patch of its own: with a table
  /// sums have another order, and what others get from `patch` must not hang on whether somebody has asked for the table.
  const Patch& tabulated() {
    if (has_table) return table;
    table = patch;
    table.prepare();
    has_table = true;
    return table;
  }

  Patch table; ///< `patch` prepared
  bool has_table = false;
};

/// All that a flow hangs on.
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
  Vec3 asked = Vec3::Zero(); ///< wrench of the last usage(), at this pose
  Pose asked_at;
  bool was_stuck = false; ///< then: the answer came from the table
  bool was_known = false; ///< then: it came from the law of a slip
  RequiredPressure answer;
  PressureState pressed;                                   ///< at the last usage()
  double onset_time = k_onset_time, end_time = k_end_time; ///< s, of the slip law's beginning and end
  OverlapLoss lost;                                        ///< at this pose
  Pose lost_at;
  bool is_lost_known = false;
  std::optional<FlowQuestion> flow_asked; ///< the last one
  Flow flow_answer;

  void follow(double tolerance) override;
};

} // namespace steplap
