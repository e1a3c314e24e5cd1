#include "transformer/verdict.h"

#include "elements/tie.h"
#include "mbd/model/method.h"
#include "mbd/model/validate.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace steplap {

namespace {

struct Worst {
  Extreme extreme;
  const Channel* channel = nullptr;
};

// How far a value is beyond its limits: negative inside, the least of the distances to them.
double excess(const Criterion& c, double value) {
  double worst = -std::numeric_limits<double>::infinity();
  if (c.within) worst = std::abs(value) - *c.within;
  if (c.at_most) worst = std::max(worst, value - *c.at_most);
  if (c.at_least) worst = std::max(worst, *c.at_least - value);
  return worst;
}

double limit_for(const Criterion& c, double value) {
  if (c.within) return *c.within;
  if (!c.at_least) return *c.at_most;
  if (!c.at_most) return *c.at_least;
  return value - *c.at_most > *c.at_least - value ? *c.at_most : *c.at_least;
}

// The extreme that is furthest beyond the limits, or nearest to them. Empty where a channel had no value.
std::optional<Worst> worst_extreme(const Criterion& c, const std::vector<ChannelRange>& ranges) {
  std::optional<Worst> worst;
  bool is_complete = true;
  for (const ChannelRange& range : ranges) {
    if (!matches_pattern(range.channel->name, c.channel)) continue;
    is_complete = is_complete && !range.had_no_value;
    for (const Extreme& extreme : {range.low, range.high})
      if (std::isnan(extreme.value)) is_complete = false;
      else if (!worst || excess(c, extreme.value) > excess(c, worst->extreme.value)) worst = Worst{extreme, range.channel};
  }
  if (worst && !is_complete && !(excess(c, worst->extreme.value) > 0.0)) return {};
  return worst;
}

// Without an exponent where that is shorter to read: "300000", not "3e+05".
std::string limit_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

std::string limits_text(const Criterion& c, const std::string& unit) {
  const std::string end = unit.empty() ? "" : " " + unit;
  if (c.within) return "|" + c.channel + "| <= " + limit_text(*c.within) + end;
  std::string text = c.channel;
  if (c.at_least) text = limit_text(*c.at_least) + end + " <= " + text;
  if (c.at_most) text += " <= " + limit_text(*c.at_most) + end;
  return text;
}

Verdict consequence_of(const Criterion& c) {
  return c.consequence == "reject" ? Verdict::reject : Verdict::inspect;
}

CriterionResult result_for(const Criterion& c, const std::string& text, const std::string& where, Verdict outcome) {
  CriterionResult result;
  result.name = c.name;
  result.text = text;
  result.reason = c.reason;
  result.consequence = consequence_of(c);
  result.outcome = outcome;
  result.where = where;
  return result;
}

CriterionResult judge_channel(const Criterion& c, const std::vector<ChannelRange>& ranges) {
  CriterionResult result = result_for(c, limits_text(c, ""), c.channel, Verdict::open);
  const std::optional<Worst> worst = worst_extreme(c, ranges);
  if (!worst) return result;
  const double value = worst->extreme.value;
  result.text = limits_text(c, worst->channel->unit);
  result.where = result.channel = worst->channel->name;
  result.reserve = -excess(c, value);
  result.unit = worst->channel->unit;
  result.value = value;
  result.limit = limit_for(c, value);
  result.t = worst->extreme.t;
  result.outcome = excess(c, value) > 0.0 ? result.consequence : Verdict::hold;
  return result;
}

// The first time that an event which is not wanted happened.
CriterionResult judge_event(const Criterion& c, const RunResult& run) {
  const std::string element = c.element.empty() ? "*" : c.element;
  const std::string whose = c.element.empty() ? "any element" : "'" + c.element + "'";
  CriterionResult result = result_for(c, "no '" + c.event + "' of " + whose, element, Verdict::hold);
  const EventKinds kinds = event_kinds_matching(c.event);
  const auto is_meant = [&](const Event& e) { return kinds.test(static_cast<std::size_t>(e.kind)) && matches_pattern(e.element, element); };
  const auto first = std::find_if(run.events.begin(), run.events.end(), is_meant);
  if (first == run.events.end()) return result;
  result.outcome = result.consequence;
  result.where = first->element;
  result.t = first->t;
  return result;
}

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
  if (joint.has_slipped) result.reserve.reset(); // that it slipped is no matter of digits
  if (joint.verdict == JointVerdict::not_assessed || joint.verdict == JointVerdict::not_known) result.outcome = Verdict::open;
  else if (joint.has_slipped || joint.smallest_margin < joint.least_margin) result.outcome = Verdict::inspect;
  if (joint.has_come_apart) result.consequence = result.outcome = Verdict::reject;
  return result;
}

void judge_least(const JointAssessment& joint, const Extreme& least, const char* channel, const std::string& text, double limit,
                 Verdict below, std::vector<CriterionResult>& criteria) {
  if (std::isnan(least.value)) return; // there is but one corner, or one packet
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

// Each corner and packet by itself: what one of them lacks is not made good by the others.
void judge_shares(const JointAssessment& joint, std::vector<CriterionResult>& criteria) {
  if (joint.verdict == JointVerdict::not_assessed) return;
  judge_least(joint, joint.least_pressure, ".least_pressure", "every interface is pressed: pressure > 0 Pa", 0.0, Verdict::reject, criteria);
  if (!std::isnan(joint.least_pressure.value)) criteria.back().unit = "Pa";
  judge_least(joint, joint.corner_margin, ".corner_margin", "each corner holds its share of the limb's weight: margin >= 1", 1.0, Verdict::inspect, criteria);
  judge_least(joint, joint.part_margin, ".part_margin", "each packet of sheets holds its own weight: margin >= 1", 1.0,
              Verdict::inspect, criteria);
}

// Only of a joint whose sheets are known.
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
    crushed.outcome = std::isnan(joint.edge_share.value) ? Verdict::open
                      : joint.has_crushed_edges()        ? Verdict::reject
                                                         : Verdict::hold;
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

// Rounding of coordinates, and what steps left joints open by, of the bodies' size: beyond it a run says nothing.
constexpr double k_rounded_share = 1e-6, k_open_share = 1e-2;

// The largest radius of gyration: what tolerances are measured by (Integrator).
double size_of(const System& system) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  return size;
}

std::string remedy(const SimulationSettings& s) {
  const bool has_steps = has_fixed_step(s.integrator);
  if (has_steps && s.step) return "try --step " + limit_text(*s.step / 10.0) + ", or --integrator auto";
  const double tolerance = s.tolerance.value_or(1e-8);
  return "try --tolerance " + limit_text(std::max(1e-12, tolerance * (tolerance > 1e-6 ? 1e-4 : 1e-2))) +
         (method(s.integrator).is_for_damping ? ", or --integrator dop853" : ", or --integrator rodas5p");
}

// A joint that holds although it cannot: of a method that locates no events, or that steps over a storm of them, whether it
// slips is not known then.
std::string contradiction_of(const Model& model, const std::vector<JointAssessment>& joints) {
  for (const JointAssessment& joint : joints)
    if (joint.contradicts_itself())
      return "'" + joint.joint + "' holds with a margin of " + limit_text(joint.smallest_margin) + " at t = " +
             limit_text(joint.time_of_smallest) + " s, and below 1 it has to slip: " + remedy(model.simulation);
  for (const JointAssessment& joint : joints)
    if (joint.bears_too_much())
      return "'" + joint.joint + "' slides with a margin of " + limit_text(joint.smallest_margin) + " at t = " +
             limit_text(joint.time_of_smallest) + " s, and below 1 nothing bears what it is said to bear: " + remedy(model.simulation);
  return "";
}

void add_distrust(Judgement& judgement, const std::string& why) {
  if (why.empty()) return;
  judgement.distrust += (judgement.distrust.empty() ? "" : "; ") + why;
}

// Energy made or lost beyond what the method's errors can be, an hundredth of what was turned over; joints that a step
// left wide open, whatever projection made of them; coordinates so large that their rounding is a motion.
std::string distrust_of(const Model& model, const System& system, const RunResult& result) {
  const RunStatistics& s = result.statistics;
  const double size = size_of(system);
  double furthest = 0.0;
  for (std::size_t i = 0; i < result.final_state.q.size(); ++i)
    if (i % 3 != 2) furthest = std::max(furthest, std::abs(result.final_state.q[i]));
  const double rounding = furthest * std::numeric_limits<double>::epsilon();
  if (rounding > k_rounded_share * size)
    return "positions of " + limit_text(furthest) + " m are known to " + limit_text(rounding) +
           " m only: let the scene begin and stay near the origin, and take common velocities away";
  if (s.max_position_residual > k_open_share * size)
    return "a step left joints open by " + limit_text(s.max_position_residual) + " m or rad: " + remedy(model.simulation);
  if (s.passed_pulse)
    return "time stepping passed over a part of a load at t = " + limit_text(*s.passed_pulse) +
           " s that is far shorter than its steps: bodies have its impulse, but no force or acceleration shows it: " + remedy(model.simulation);
  if (s.energy_residual > EnergyAccount::k_untrusted * s.energy_scale && s.energy_residual > s.energy_rounding)
    return "the energy balance is off by " + limit_text(s.energy_residual) + " J of " + limit_text(s.energy_scale) +
           " J turned over: " + remedy(model.simulation);
  return "";
}

} // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
  case Verdict::hold:
    return "hold";
  case Verdict::open:
    return "open";
  case Verdict::inspect:
    return "inspect";
  case Verdict::reject:
    break;
  }
  return "reject";
}

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

namespace {

// Of a tie that has a strength: that it does not break.
void judge_tie(const Tie& tie, const RunResult& run, std::vector<CriterionResult>& criteria) {
  CriterionResult result;
  result.name = result.where = tie.name;
  result.text = "the tie does not break: its force, of its strength < 1";
  result.consequence = tie.consequence == "inspect" ? Verdict::inspect : Verdict::reject;
  result.outcome = Verdict::open;
  result.limit = 1.0;
  for (const ChannelRange& range : run.ranges) {
    if (range.channel->name != tie.name + ".strength_share" || std::isnan(range.high.value)) continue;
    result.outcome = Verdict::hold;
    result.value = range.high.value;
    result.t = range.high.t;
    result.channel = range.channel->name;
    result.reserve = 1.0 - range.high.value;
  }
  for (const Event& event : run.events)
    if (event.kind == EventKind::breaks && event.element == tie.name) {
      result.outcome = result.consequence;
      result.t = event.t;
      result.reserve.reset(); // that it broke is no matter of digits
    }
  criteria.push_back(result);
}

} // namespace

Judgement judge(const Model& model, const System& system, const RunResult& result, const std::string& failure) {
  Judgement judgement;
  const std::vector<JointAssessment> joints = assess_joints(model, result);
  for (const JointAssessment& joint : joints) {
    judgement.criteria.push_back(judge_holding(joint));
    judge_shares(joint, judgement.criteria);
    judge_overlap(joint, judgement.criteria);
  }
  for (const ElementEntry& entry : model.elements)
    if (const auto* tie = dynamic_cast<const Tie*>(entry.element.get()); tie && tie->strength && tie->consequence != "none") judge_tie(*tie, result, judgement.criteria);
  for (const Criterion& c : model.criteria)
    judgement.criteria.push_back(c.event.empty() ? judge_channel(c, result.ranges) : judge_event(c, result));
  judgement.has_criteria = !judgement.criteria.empty();
  for (const JointAssessment& joint : joints)
    if (joint.is_known() && !joint.is_loaded)
      add_cap(judgement, "nothing loaded '" + joint.joint + "' but its limb's weight: a run that asks nothing of a joint does not show that it holds");
  judgement.so_far = judgement.has_criteria ? Verdict::hold : Verdict::open;
  for (const CriterionResult& c : judgement.criteria)
    judgement.so_far = std::max(judgement.so_far, c.outcome);
  if (failure.empty()) {
    judgement.distrust = distrust_of(model, system, result);
    add_distrust(judgement, contradiction_of(model, joints));
  }
  judgement.verdict = failure.empty() && judgement.distrust.empty() ? judgement.so_far : Verdict::open;
  if (!judgement.caps.empty()) judgement.verdict = std::max(judgement.verdict, Verdict::open);
  return judgement;
}

void add_cap(Judgement& judgement, const std::string& why) {
  judgement.caps.push_back(why);
  judgement.verdict = std::max(judgement.verdict, Verdict::open);
}

} // namespace steplap
