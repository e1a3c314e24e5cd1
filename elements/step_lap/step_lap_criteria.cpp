#include "elements/step_lap/step_lap_criteria.h"

#include "elements/step_lap/step_lap_assessment.h"
#include "elements/step_lap/step_lap_joint.h"

#include <cmath>

namespace steplap {

namespace {

CriterionResult joint_result(const JointAssessment& joint, const std::string& text) {
  CriterionResult result;
  result.name = result.where = joint.joint;
  result.text = text;
  return result;
}

CriterionResult judge_holding(const JointAssessment& joint) {
  const bool has_reserve = joint.least_margin > 1.0;
  CriterionResult result = joint_result(joint, has_reserve ? "the step-lap joint holds, margin at least " + limit_text(joint.least_margin)
                                                           : "the step-lap joint holds");
  if (std::isfinite(joint.smallest_margin)) {
    result.value = joint.smallest_margin;
    result.limit = joint.least_margin;
    result.channel = joint.joint + ".margin";
    result.reserve = joint.smallest_margin - joint.least_margin;
    result.t = joint.time_of_smallest;
  }
  if (joint.first_slip) result.t = joint.first_slip;
  if (joint.has_slipped) result.reserve.reset(); // a slip is certain, whatever the error
  if (joint.verdict == JointVerdict::not_assessed || joint.verdict == JointVerdict::not_known) result.outcome = Verdict::open;
  else if (joint.has_slipped || joint.smallest_margin < joint.least_margin) result.outcome = Verdict::inspect;
  if (joint.has_come_apart) result.consequence = result.outcome = Verdict::reject;
  return result;
}

void judge_least(const JointAssessment& joint, const Extreme& least, const char* channel, const std::string& text, double limit,
                 Verdict below, std::vector<CriterionResult>& criteria) {
  if (std::isnan(least.value)) return; // a joint with only one corner or packet has no value
  CriterionResult result = joint_result(joint, text);
  result.value = least.value;
  result.limit = limit;
  result.t = least.t;
  result.channel = joint.joint + channel;
  result.reserve = least.value - limit;
  result.consequence = least.value <= 0.0 ? Verdict::reject : below;
  if (least.value <= 0.0 || least.value < limit) result.outcome = result.consequence;
  criteria.push_back(result);
}

// Judges the weakest corner and the weakest packet separately, because the others do not compensate for them.
void judge_shares(const JointAssessment& joint, std::vector<CriterionResult>& criteria) {
  if (joint.verdict == JointVerdict::not_assessed) return;
  judge_least(joint, joint.least_pressure, ".least_pressure", "every interface is pressed: pressure > 0 Pa", 0.0, Verdict::reject,
              criteria);
  if (!std::isnan(joint.least_pressure.value)) criteria.back().unit = "Pa";
  judge_least(joint, joint.corner_margin, ".corner_margin", "each corner holds its share of the limb's weight: margin >= 1", 1.0,
              Verdict::inspect, criteria);
  judge_least(joint, joint.part_margin, ".part_margin", "each packet of sheets holds its share of the load: margin >= 1", 1.0,
              Verdict::inspect, criteria);
}

// Judges the overlap of joints with known sheets.
void judge_overlap(const JointAssessment& joint, std::vector<CriterionResult>& criteria) {
  if (joint.verdict == JointVerdict::not_assessed) return;
  CriterionResult slid = joint_result(joint, "displacement of its corners, of the overlap's width <= " + limit_text(joint.most_slide));
  slid.consequence = Verdict::reject;
  slid.outcome = std::isnan(joint.slid_share.value) ? Verdict::open : Verdict::hold;
  slid.value = joint.slid_share.value;
  slid.limit = joint.most_slide;
  slid.t = joint.slid_share.t;
  slid.channel = joint.joint + ".slid_share";
  slid.reserve = joint.most_slide - joint.slid_share.value;
  if (joint.has_slid_too_far()) slid.outcome = Verdict::reject;
  criteria.push_back(slid);
  if (joint.has_parted()) {
    CriterionResult parted = joint_result(joint, "no corner parts: share of the overlap left > 0");
    parted.outcome = parted.consequence = Verdict::reject;
    parted.value = joint.overlap_left.value;
    parted.limit = 0.0;
    parted.t = joint.overlap_left.t;
    parted.channel = joint.joint + ".overlap_left";
    parted.reserve = joint.overlap_left.value;
    criteria.push_back(parted);
  }
  if (joint.allowed_line_load) {
    CriterionResult crushed = joint_result(joint, "line load of its sheet edges, of the allowed one <= 1");
    crushed.consequence = Verdict::reject;
    crushed.outcome = std::isnan(joint.edge_share.value) ? Verdict::open : joint.has_crushed_edges() ? Verdict::reject : Verdict::hold;
    crushed.value = joint.edge_share.value;
    crushed.limit = 1.0;
    crushed.t = joint.edge_share.t;
    crushed.channel = joint.joint + ".edge_share";
    crushed.reserve = 1.0 - joint.edge_share.value;
    criteria.push_back(crushed);
  }
  if (joint.has_edges || std::isnan(joint.clearance_left.value)) return;
  CriterionResult closed = joint_result(joint, "the limb closes no clearance: left >= 0 m");
  closed.reason = "beyond it the sheets of a layer butt, of which the model knows nothing: the run is outside its range from then on";
  closed.outcome = joint.has_left_range() ? Verdict::inspect : Verdict::hold;
  closed.value = joint.clearance_left.value;
  closed.limit = 0.0;
  closed.unit = "m";
  closed.t = joint.clearance_left.t;
  closed.channel = joint.joint + ".clearance_left";
  closed.reserve = joint.clearance_left.value + JointAssessment::k_touching;
  criteria.push_back(closed);
}

// Returns the message for a joint that sticks beyond its capacity; empty for others. This occurs with methods that do not locate events or
// step over a storm of events. It is then unknown whether the joint slips.
std::string contradiction_of(const JointAssessment& joint, const SimulationSettings& settings) {
  const char* does = joint.contradicts_itself() ? "holds" : joint.exceeds_capacity() ? "slides" : "";
  const std::string then = joint.contradicts_itself() ? "it has to slip" : "no element carries the stated load";
  if (*does == '\0') return "";
  return "'" + joint.joint + "' " + does + " with a margin of " + limit_text(joint.smallest_margin) +
         " at t = " + limit_text(joint.time_of_smallest) + " s, and below 1 " + then + ": " + remedy(settings);
}

} // namespace

ElementJudgement judge_step_lap_joint(const Element& element, const Model& model, const RunResult& result) {
  const JointAssessment joint = assess_joint(static_cast<const StepLapJoint&>(element), model, result);
  ElementJudgement judgement;
  judgement.criteria.push_back(judge_holding(joint));
  judge_shares(joint, judgement.criteria);
  judge_overlap(joint, judgement.criteria);
  if (joint.is_known() && !joint.is_loaded)
    judgement.caps.push_back("nothing loaded '" + joint.joint +
                             "' but its limb's weight: a run that asks nothing of a joint does not show that it holds");
  judgement.distrust = contradiction_of(joint, model.simulation);
  return judgement;
}

std::vector<std::string> trust_of_step_lap_joint(const Element& element) { return {element.name + ".margin", element.name + ".mode"}; }

} // namespace steplap
