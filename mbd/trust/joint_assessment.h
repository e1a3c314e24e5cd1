// Assessment of a joint that is held by friction over an area: figures and verdict for one joint after a run. Extreme values cover the
// whole run (mbd/simulation/extremes.h), whatever the output step. The kind of the joint computes the figures.
#pragma once

#include "mbd/simulation/simulation.h"
#include "mbd/trust/global_error.h"
#include "mbd/trust/judgement.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Verdict on one joint. Entries are in descending order of severity.
enum class JointVerdict : std::uint8_t {
  not_assessed, ///< a joint without interfaces, which cannot slip
  came_apart,
  corner_parted,
  unpressed, ///< an interface without pressure, or a corner or packet without capacity
  slid_too_far,
  crushed_edges,
  closed_clearance,
  slipped,
  not_known,      ///< no figures available
  would_slip,     ///< a monitored joint that exceeds its limit
  weak_part,      ///< a corner or a packet of sheets cannot hold its own share of the weight
  little_reserve, ///< less margin than the model requires
  holds
};

/// Returns the text of a verdict, such as "a corner parted".
[[nodiscard]] const char* words_of(JointVerdict verdict);
/// Returns the verdict on the run to which this joint alone leads.
[[nodiscard]] Verdict outcome_of(JointVerdict verdict);

/// An element that carries load between the same two bodies as a joint.
struct SharedLoad {
  std::string element;
  double largest = 0.0; ///< largest absolute force over the run, N; NaN if it has no such channel
};

/// Figures and verdict of one joint.
struct JointAssessment {
  static constexpr double k_touching = 1e-9;    ///< m: tolerance for rounding of a clearance that is zero
  static constexpr double k_held_beyond = 1e-6; ///< relative to the margin: accuracy of locating the onset of slip
  static constexpr double k_off_surface = 1e-2; ///< relative to the margin: error of a sliding joint with steps of usual tolerance
  std::string joint;
  bool has_slipped = false;
  std::optional<double> first_slip;        ///< s; for a monitored joint the time at which it would have slipped
  double largest_required_pressure = 0.0;  ///< Pa
  double time_of_largest = 0.0;            ///< s
  double smallest_margin = 0.0;            ///< capacity/demand; below 1 the joint slips, or would slip
  double time_of_smallest = 0.0;           ///< s
  double least_margin = 1.0;               ///< margin that the model requires
  Extreme least_pressure;                  ///< Pa, of any interface at any time
  Extreme corner_margin, part_margin;      ///< smallest margin of a single corner or packet; NaN if there is only one
  double largest_demand = 0.0;             ///< largest force on the limb, N
  double weight = 0.0;                     ///< weight of the limb, N
  bool is_loaded = false;                  ///< the force on the limb changed by more than rounding, relative to its weight
  double slid_x = 0.0, slid_y = 0.0;       ///< m, at the end, in the axes of the active part
  double slid_angle = 0.0;                 ///< rotation at the end, rad (θ_acc)
  double area_lost = 0.0;                  ///< m², at the end, over all interfaces, each times the number of equal ones
  Extreme slid_share;                      ///< largest displacement of a corner relative to the width of its overlap
  double most_slide = 0.0;                 ///< limit of slid_share in the model
  Extreme overlap_left;                    ///< smallest remaining fraction of a corner's overlap
  Extreme clearance_left;                  ///< smallest, m; NaN if the model gives no clearance
  Extreme edge_share;                      ///< largest line load of sheet edges relative to the allowed one; NaN without an allowed one
  Extreme edge_load;                       ///< largest line load, N/m; NaN without edges
  Extreme edge_pressure;                   ///< Pa, edge_load over the thickness of the steel; NaN if that is not given
  std::optional<double> allowed_line_load; ///< N/m
  bool has_edges = false;                  ///< sheet edges are modelled as contacts
  std::vector<SharedLoad> shared_with;     ///< elements in parallel; the joint's margin refers to the remaining load
  bool is_elastic = false;                 ///< the joint has a stiffness; otherwise elements in parallel carry nothing before it slides
  bool has_come_apart = false;
  bool is_monitored = false;

  [[nodiscard]] bool has_parted() const { return overlap_left.value <= 0.0; } ///< a whole corner has separated
  /// Returns true if a part of the joint has no pressure or no capacity.
  [[nodiscard]] bool is_unpressed() const { return least_pressure.value <= 0.0 || corner_margin.value <= 0.0 || part_margin.value <= 0.0; }
  [[nodiscard]] bool has_weak_part() const { return corner_margin.value < 1.0 || part_margin.value < 1.0; }
  [[nodiscard]] bool has_slid_too_far() const { return slid_share.value > most_slide; }
  [[nodiscard]] bool has_crushed_edges() const { return edge_share.value > 1.0; }
  /// Returns the allowed line load over the largest one; infinite if no edge was loaded, NaN if no allowed line load is given.
  [[nodiscard]] double edge_margin() const { return 1.0 / edge_share.value; }
  /// Returns true if the clearance has closed. The sheets then touch end to end, which the model contains only if it has edges.
  [[nodiscard]] bool has_left_range() const;
  /// Returns true if the joint takes part in the motion and never slipped although its margin was below 1, which is impossible.
  [[nodiscard]] bool contradicts_itself() const {
    return !is_monitored && !has_slipped && !has_come_apart && smallest_margin < 1.0 - k_held_beyond;
  }
  /// Returns true if the joint takes part in the motion and carried clearly more than its capacity, so that results within steps are
  /// unreliable.
  [[nodiscard]] bool exceeds_capacity() const { return !is_monitored && !has_come_apart && smallest_margin < 1.0 - k_off_surface; }
  [[nodiscard]] bool is_known() const { return smallest_margin == smallest_margin; }

  JointVerdict verdict = JointVerdict::not_assessed;
};

/// Errors of the figures of a JointAssessment, in their units; NaN if unknown.
struct JointErrors {
  double first_slip = 0.0, largest_required_pressure = 0.0, time_of_largest = 0.0, smallest_margin = 0.0;
  double slid_x = 0.0, slid_y = 0.0, slid_angle = 0.0, area_lost = 0.0;
  double slid_share = 0.0, overlap_left = 0.0, clearance_left = 0.0, edge_load = 0.0, edge_share = 0.0;
};

[[nodiscard]] JointErrors joint_errors(const JointAssessment& joint, const System& system, const RunResult& run,
                                       const GlobalErrorEstimate& estimate);

} // namespace steplap
