#include "transformer/joint_assessment.h"

#include "elements/step_lap_interface.h"
#include "elements/step_lap_joint.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

// The channel's values over the samples; empty if the trajectory does not hold it.
std::vector<double> samples(const Trajectory& trajectory, const std::string& name) {
  for (const Channel* channel : trajectory.channels())
    if (channel->name == name) return trajectory.series(name);
  return {};
}

double last_of(const std::vector<double>& values) { return values.empty() ? k_unknown : values.back(); }

// Channels may be not-a-number where they have no meaning (a margin without load).
void find_extremes(const Trajectory& trajectory, JointAssessment& result) {
  const std::vector<double> pressure = samples(trajectory, result.joint + ".p_req");
  const std::vector<double> margin = samples(trajectory, result.joint + ".margin");
  result.largest_required_pressure = pressure.empty() ? k_unknown : 0.0;
  for (std::size_t i = 0; i < pressure.size(); ++i)
    if (pressure[i] > result.largest_required_pressure) {
      result.largest_required_pressure = pressure[i];
      result.time_of_largest = trajectory.times()[i];
    }
  result.smallest_margin = margin.empty() ? k_unknown : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < margin.size(); ++i) {
    if (!(margin[i] < result.smallest_margin)) continue;
    result.smallest_margin = margin[i];
  }
  if (!result.is_monitored) return;
  for (std::size_t i = 0; i < margin.size() && !result.first_slip; ++i)
    if (margin[i] < 1.0) result.first_slip = trajectory.times()[i];
}

void read_events(const std::vector<Event>& events, JointAssessment& result) {
  for (const Event& event : events) {
    if (event.element != result.joint) continue;
    if (event.what.starts_with("slips")) {
      result.has_slipped = true;
      if (!result.first_slip) result.first_slip = event.t;
    }
    if (event.what.starts_with("comes apart")) result.has_come_apart = true;
  }
}

// One that slides from the first instant has no event of beginning to.
void read_modes(const Trajectory& trajectory, JointAssessment& result) {
  const std::vector<double> mode = samples(trajectory, result.joint + ".mode");
  for (std::size_t i = 0; i < mode.size(); ++i) {
    if (mode[i] != static_cast<double>(FrictionPhase::slip)) continue;
    result.has_slipped = true;
    if (!result.first_slip || trajectory.times()[i] < *result.first_slip) result.first_slip = trajectory.times()[i];
    return;
  }
}

std::string verdict_of(const JointAssessment& a, bool has_interfaces) {
  if (!has_interfaces) return "not assessed";
  if (a.has_come_apart) return "came apart";
  if (a.has_slipped) return "slipped";
  return a.is_monitored && a.first_slip ? "would slip" : "holds";
}

} // namespace

std::vector<JointAssessment> assess_joints(const Model& model, const RunResult& result) {
  std::vector<JointAssessment> assessments;
  const Trajectory& trajectory = *result.trajectory;
  for (const ElementEntry& entry : model.elements) {
    const auto* joint = dynamic_cast<const StepLapJoint*>(entry.element.get());
    if (!joint) continue;
    JointAssessment a;
    a.joint = joint->name;
    a.is_monitored = joint->mode == "monitor";
    read_events(result.events, a);
    read_modes(*result.trajectory, a);
    find_extremes(trajectory, a);
    a.slid_x = last_of(samples(trajectory, a.joint + ".dx"));
    a.slid_y = last_of(samples(trajectory, a.joint + ".dy"));
    a.slid_angle = last_of(samples(trajectory, a.joint + ".theta_acc"));
    const std::vector<double> area = samples(trajectory, a.joint + ".area");
    a.area_lost = area.empty() ? k_unknown : area.front() - area.back();
    const bool has_interfaces =
        std::any_of(model.elements.begin(), model.elements.end(), [&](const ElementEntry& other) {
          const auto* face = dynamic_cast<const StepLapInterface*>(other.element.get());
          return face && face->joint == joint->name;
        });
    a.verdict = verdict_of(a, has_interfaces);
    assessments.push_back(a);
  }
  return assessments;
}

} // namespace steplap
