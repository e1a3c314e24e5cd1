#include "transformer/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace steplap {

namespace {

struct Sample {
  double value = 0.0, t = 0.0;
  std::size_t column = 0;
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

// The sample that is furthest beyond the limits, or nearest to them; not-a-number has no say.
std::optional<Sample> worst_sample(const Criterion& c, const Trajectory& trajectory) {
  std::optional<Sample> worst;
  for (std::size_t column = 0; column < trajectory.channels().size(); ++column) {
    if (!matches_pattern(trajectory.channels()[column]->name, c.channel)) continue;
    for (std::size_t row = 0; row < trajectory.size(); ++row) {
      const double value = trajectory.value(row, column);
      if (std::isnan(value)) continue;
      if (!worst || excess(c, value) > excess(c, worst->value))
        worst = Sample{value, trajectory.times()[row], column};
    }
  }
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

CriterionResult judge_channel(const Criterion& c, const Trajectory& trajectory) {
  CriterionResult result{c.name, limits_text(c, ""), c.reason, consequence_of(c), Verdict::open, c.channel, {}, {}, {}, ""};
  const std::optional<Sample> worst = worst_sample(c, trajectory);
  if (!worst) return result;
  const Channel& channel = *trajectory.channels()[worst->column];
  result.text = limits_text(c, channel.unit);
  result.where = channel.name;
  result.unit = channel.unit;
  result.value = worst->value;
  result.limit = limit_for(c, worst->value);
  result.t = worst->t;
  result.outcome = excess(c, worst->value) > 0.0 ? result.consequence : Verdict::hold;
  return result;
}

CriterionResult judge_event(const Criterion& c, const std::vector<Event>& events) {
  const std::string element = c.element.empty() ? "*" : c.element;
  CriterionResult result{c.name, "no '" + c.event + "' of " + (c.element.empty() ? "any element" : "'" + c.element + "'"),
                         c.reason, consequence_of(c), Verdict::hold, element, {}, {}, {}, ""};
  const auto found = std::find_if(events.begin(), events.end(), [&](const Event& e) {
    return matches_pattern(e.element, element) && matches_pattern(e.what, c.event);
  });
  if (found == events.end()) return result;
  result.outcome = result.consequence;
  result.where = found->element;
  result.t = found->t;
  return result;
}

CriterionResult judge_joint(const JointAssessment& joint) {
  CriterionResult result{joint.joint, "the step-lap joint holds", "", Verdict::inspect, Verdict::hold, joint.joint, {}, {}, {}, ""};
  if (std::isfinite(joint.smallest_margin)) {
    result.value = joint.smallest_margin;
    result.limit = 1.0;
  }
  result.t = joint.first_slip;
  if (joint.verdict == "not assessed") result.outcome = Verdict::open;
  if (joint.verdict == "slipped" || joint.verdict == "would slip") result.outcome = Verdict::inspect;
  if (joint.has_come_apart) result.consequence = result.outcome = Verdict::reject;
  return result;
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

Judgement judge(const Model& model, const RunResult& result, const std::string& failure) {
  Judgement judgement;
  for (const JointAssessment& joint : assess_joints(model, result))
    judgement.criteria.push_back(judge_joint(joint));
  for (const Criterion& c : model.criteria)
    judgement.criteria.push_back(c.event.empty() ? judge_channel(c, *result.trajectory) : judge_event(c, result.events));
  judgement.has_criteria = !judgement.criteria.empty();
  judgement.verdict = failure.empty() && judgement.has_criteria ? Verdict::hold : Verdict::open;
  for (const CriterionResult& c : judgement.criteria)
    judgement.verdict = std::max(judgement.verdict, c.outcome);
  return judgement;
}

} // namespace steplap
