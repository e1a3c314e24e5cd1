// What a run did to each step-lap joint: the figures and the verdict that the receiver asks for.
#pragma once

#include "mbd/model.h"
#include "mbd/simulation.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct JointAssessment {
  std::string joint;
  bool has_slipped = false;
  std::optional<double> first_slip;        ///< s; also for a monitored joint that would have slipped
  double largest_required_pressure = 0.0;  ///< Pa, over the samples
  double time_of_largest = 0.0;            ///< s
  double smallest_margin = 0.0;            ///< capacity over demand; below 1: it slips, or would
  double slid_x = 0.0, slid_y = 0.0;       ///< m, at the end, in the active part's axes
  double slid_angle = 0.0;                 ///< rad, θ_acc at the end
  double area_lost = 0.0;                  ///< m², since the start
  bool has_come_apart = false;
  bool is_monitored = false;

  /// "holds", "slipped", "came apart", "would slip" (a monitored joint beyond its limit), "not assessed"
  /// (a joint without interfaces, which holds whatever it takes).
  std::string verdict;
};

/// One entry for every step_lap_joint of the model, in the model's order. Channels that the trajectory
/// does not hold leave their figures not-a-number.
[[nodiscard]] std::vector<JointAssessment> assess_joints(const Model& model, const RunResult& result);

} // namespace steplap
