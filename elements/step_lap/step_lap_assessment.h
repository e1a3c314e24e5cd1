// What a run did to each step-lap joint: the figures and the verdict that the receiver asks for. All figures are of
// the extremes of the run (mbd/simulation/extremes.h), whatever was written.
#pragma once

#include "mbd/model/model.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judgement.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct StepLapJoint;

/// From the gravest down.
enum class JointVerdict : std::uint8_t {
  not_assessed, ///< a joint without interfaces, which holds whatever it takes
  came_apart,
  corner_parted,
  unpressed, ///< nothing presses some interface, or a corner or packet has nothing to hold by
  slid_too_far,
  crushed_edges,
  closed_clearance,
  slipped,
  not_known,      ///< no figures
  would_slip,     ///< a monitored joint beyond its limit
  weak_part,      ///< a corner or a packet of sheets cannot hold its share of the weight
  little_reserve, ///< less margin than the model asks for
  holds
};

/// "a corner parted"
[[nodiscard]] const char* words_of(JointVerdict verdict);
/// Of a joint by itself.
[[nodiscard]] Verdict outcome_of(JointVerdict verdict);

/// What bears between the same two bodies as a joint.
struct SharedLoad {
  std::string element;
  double largest = 0.0; ///< N, of its force over the run, either way; not-a-number if it reports none
};

struct JointAssessment {
  static constexpr double k_touching = 1e-9;    ///< m: a clearance of zero is not closed by rounding
  static constexpr double k_held_beyond = 1e-6; ///< of the margin: what locating an onset of slip may leave
  static constexpr double k_off_surface = 1e-2; ///< of the margin: what steps of a usual tolerance leave of a joint that slides
  std::string joint;
  bool has_slipped = false;
  std::optional<double> first_slip;        ///< s; also for a monitored joint that would have slipped
  double largest_required_pressure = 0.0;  ///< Pa
  double time_of_largest = 0.0;            ///< s
  double smallest_margin = 0.0;            ///< capacity over demand; below 1: it slips, or would
  double time_of_smallest = 0.0;           ///< s
  double least_margin = 1.0;               ///< that the model asks for
  Extreme least_pressure;                  ///< Pa, of any interface at any time
  Extreme corner_margin, part_margin;      ///< the least that a corner or a packet had by itself; not-a-number where there is but one
  double largest_demand = 0.0;             ///< N, the largest force on the limb
  double weight = 0.0;                     ///< N, of the limb
  bool is_loaded = false;                  ///< the force on it changed by more than rounding of its weight
  double slid_x = 0.0, slid_y = 0.0;       ///< m, at the end, in the active part's axes
  double slid_angle = 0.0;                 ///< rad, θ_acc at the end
  double area_lost = 0.0;                  ///< m², at the end: of interfaces that lost some, times their number
  Extreme slid_share;                      ///< largest displacement of a corner, of the width of its overlap
  double most_slide = 0.0;                 ///< that the model bears
  Extreme overlap_left;                    ///< least share of its overlap that a corner had left
  Extreme clearance_left;                  ///< m, the least; not-a-number if the model states no clearance
  Extreme edge_share;                      ///< largest line load of sheet edges, of the allowed one; not-a-number without
  Extreme edge_load;                       ///< N/m, the largest; not-a-number without edges
  Extreme edge_pressure;                   ///< Pa, the same over the steel's thickness; not-a-number where that is not known
  std::optional<double> allowed_line_load; ///< N/m
  bool has_edges = false;                  ///< edges that bear are part of the model
  std::vector<SharedLoad> shared_with;     ///< its own margin is of what these leave it
  bool is_elastic = false;                 ///< if not, what is beside it bears nothing until it slides
  bool has_come_apart = false;
  bool is_monitored = false;

  [[nodiscard]] bool has_parted() const { return overlap_left.value <= 0.0; } ///< a whole corner
  /// Something of it holds by nothing.
  [[nodiscard]] bool is_unpressed() const { return least_pressure.value <= 0.0 || corner_margin.value <= 0.0 || part_margin.value <= 0.0; }
  [[nodiscard]] bool has_weak_part() const { return corner_margin.value < 1.0 || part_margin.value < 1.0; }
  [[nodiscard]] bool has_slid_too_far() const { return slid_share.value > most_slide; }
  [[nodiscard]] bool has_crushed_edges() const { return edge_share.value > 1.0; }
  /// Allowed line load over the largest; infinite if no edge bore. Not-a-number without an allowed one.
  [[nodiscard]] double edge_margin() const { return 1.0 / edge_share.value; }
  /// It has closed its clearance: sheets butt, of which the model knows nothing (unless it has edges).
  [[nodiscard]] bool has_left_range() const;
  /// It is part of the motion, never slipped, and yet had less than it needed to hold.
  [[nodiscard]] bool contradicts_itself() const {
    return !is_monitored && !has_slipped && !has_come_apart && smallest_margin < 1.0 - k_held_beyond;
  }
  /// A part of the motion, it was found to bear more than it can: what the method says of the motion within a step is not so.
  [[nodiscard]] bool bears_too_much() const { return !is_monitored && !has_come_apart && smallest_margin < 1.0 - k_off_surface; }
  [[nodiscard]] bool is_known() const { return smallest_margin == smallest_margin; }

  JointVerdict verdict = JointVerdict::not_assessed;
};

/// Figures are not-a-number where the run did not look for extremes.
[[nodiscard]] JointAssessment assess_joint(const StepLapJoint& joint, const Model& model, const RunResult& result);
/// One entry for every step_lap_joint of the model, in the model's order.
[[nodiscard]] std::vector<JointAssessment> assess_joints(const Model& model, const RunResult& result);

/// Errors of the figures of a JointAssessment, in their units; not-a-number where unknown.
struct JointErrors {
  double first_slip = 0.0, largest_required_pressure = 0.0, time_of_largest = 0.0, smallest_margin = 0.0;
  double slid_x = 0.0, slid_y = 0.0, slid_angle = 0.0, area_lost = 0.0;
  double slid_share = 0.0, overlap_left = 0.0, clearance_left = 0.0, edge_load = 0.0, edge_share = 0.0;
};

[[nodiscard]] JointErrors joint_errors(const JointAssessment& joint, const System& system, const RunResult& run,
                                       const GlobalErrorEstimate& estimate);

} // namespace steplap
