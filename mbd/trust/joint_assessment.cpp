#include "mbd/trust/joint_assessment.h"

#include "mbd/trust/weighed_errors.h"

namespace steplap {

const char* words_of(JointVerdict verdict) {
  switch (verdict) {
  case JointVerdict::not_assessed: return "not assessed";
  case JointVerdict::came_apart: return "came apart";
  case JointVerdict::corner_parted: return "a corner parted";
  case JointVerdict::unpressed: return "not pressed everywhere";
  case JointVerdict::slid_too_far: return "slid too far";
  case JointVerdict::crushed_edges: return "crushed its edges";
  case JointVerdict::closed_clearance: return "closed its clearance";
  case JointVerdict::slipped: return "slipped";
  case JointVerdict::not_known: return "not known";
  case JointVerdict::would_slip: return "would slip";
  case JointVerdict::weak_part: return "a corner or packet too weak";
  case JointVerdict::little_reserve: return "little reserve";
  case JointVerdict::holds: break;
  }
  return "holds";
}

bool JointAssessment::has_left_range() const { return !has_edges && clearance_left.value < -k_touching; }

Verdict outcome_of(JointVerdict verdict) {
  switch (verdict) {
  case JointVerdict::holds: return Verdict::hold;
  case JointVerdict::not_assessed:
  case JointVerdict::not_known: return Verdict::open;
  case JointVerdict::came_apart:
  case JointVerdict::corner_parted:
  case JointVerdict::unpressed:
  case JointVerdict::crushed_edges:
  case JointVerdict::slid_too_far: return Verdict::reject;
  default: return Verdict::inspect;
  }
}

JointErrors joint_errors(const JointAssessment& joint, const System& system, const RunResult& run, const GlobalErrorEstimate& estimate) {
  const auto of = [&](const char* channel, double ChannelError::*which) {
    const ChannelError* error = find_error(joint.joint + channel, system, estimate);
    return error ? error->*which : k_unknown_error;
  };
  JointErrors e;
  e.largest_required_pressure = of(".p_req", &ChannelError::high);
  e.time_of_largest = of(".p_req", &ChannelError::t_high);
  e.smallest_margin = of(".margin", &ChannelError::low);
  e.slid_x = of(".dx", &ChannelError::final);
  e.slid_y = of(".dy", &ChannelError::final);
  e.slid_angle = of(".theta_acc", &ChannelError::final);
  e.area_lost = of(".area_lost", &ChannelError::final);
  e.slid_share = of(".slid_share", &ChannelError::high);
  e.overlap_left = of(".overlap_left", &ChannelError::low);
  e.clearance_left = of(".clearance_left", &ChannelError::low);
  e.edge_load = of(".edge_load", &ChannelError::high);
  e.edge_share = of(".edge_share", &ChannelError::high);
  if (!joint.first_slip) return e;
  const std::optional<double> at_event = event_error(joint.joint, *joint.first_slip, run, estimate);
  if (at_event) e.first_slip = *at_event;
  else if (joint.is_monitored) e.first_slip = of(".u", &ChannelError::first_above_one);
  else if (*joint.first_slip > 0.0) e.first_slip = of(".mode", &ChannelError::t_high);
  return e;
}

} // namespace steplap
