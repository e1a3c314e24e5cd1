#include "mbd/trust/criteria.h"

#include "mbd/base/name_pattern.h"
#include "mbd/trust/element_judgement.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

struct Worst {
  Extreme extreme;
  const Channel* channel = nullptr;
};

// Returns how far a value exceeds its limits, in its unit. Within the limits the result is negative: minus the distance to the nearest
// limit.
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

// Returns the extreme that exceeds the limits most, or comes nearest to them; nothing if a channel has no value.
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

std::string limits_text(const Criterion& c, const std::string& unit) {
  const std::string end = unit.empty() ? "" : " " + unit;
  if (c.within) return "|" + c.channel + "| <= " + limit_text(*c.within) + end;
  std::string text = c.channel;
  if (c.at_least) text = limit_text(*c.at_least) + end + " <= " + text;
  if (c.at_most) text += " <= " + limit_text(*c.at_most) + end;
  return text;
}

Verdict consequence_of(const Criterion& c) { return c.consequence == "reject" ? Verdict::reject : Verdict::inspect; }

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

// Judges a criterion that forbids an event; the value is the time of the first such event.
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

} // namespace

CriterionResult judge_criterion(const Criterion& criterion, const RunResult& result) {
  return criterion.event.empty() ? judge_channel(criterion, result.ranges) : judge_event(criterion, result);
}

} // namespace steplap
