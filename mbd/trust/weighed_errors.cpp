#include "mbd/trust/weighed_errors.h"

#include "mbd/trust/element_judgement.h"
#include "mbd/trust/event_match.h"
#include "mbd/trust/judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace steplap {

const ChannelError* find_error(const std::string& channel, const System& system, const GlobalErrorEstimate& estimate) {
  for (std::size_t c = 0; c < system.channels.size(); ++c)
    if (system.channels[c].name == channel) return &estimate.channels[c];
  return nullptr;
}

std::optional<double> event_error(const std::string& element, double t, const RunResult& run, const GlobalErrorEstimate& estimate) {
  for (std::size_t i = 0; i < run.events.size(); ++i)
    if (run.events[i].t == t && run.events[i].element == element) return estimate.event_times[i];
  return {};
}

namespace {

constexpr const char* k_smaller_step = "try a smaller step, or the integrator auto";
constexpr double k_most_trusted_error = 0.1; // largest error, as a fraction of the range of positions, or of a slid distance
// Slid distances below these count as none: fractions of the largest range of displacements, and of the bodies' size. Errors are controlled
// to 1e-3 of that size (Integrator).
constexpr double k_slide_share = 1e-6, k_size_share = 1e-9;

void set_errors(CriterionResult& c, const System& system, const RunResult& run, const GlobalErrorEstimate& estimate) {
  const ChannelRange* range = find_range(run, c.channel);
  if (c.value && range) {
    const ChannelError& error = *find_error(c.channel, system, estimate);
    const bool is_low = *c.value == range->low.value;
    c.error = is_low ? error.low : error.high;
    if (c.t && *c.t == (is_low ? range->low.t : range->high.t)) c.t_error = is_low ? error.t_low : error.t_high;
  }
  if (!c.t || c.t_error) return;
  c.t_error = event_error(c.where, *c.t, run, estimate);
  if (!c.t_error && *c.t == 0.0) c.t_error = 0.0; // a monitored joint that exceeds its limit from the start
  if (c.t_error) return;
  const ChannelError* usage = find_error(c.where + ".u", system, estimate); // monitored joint: time at which utilisation passed 1
  c.t_error = usage ? usage->first_above_one : k_unknown_error;
}

// Returns a text on why the result of a criterion is uncertain; "" if it is not. `finer`: the same criterion in a finer run.
std::string doubt_about(const CriterionResult& c, const CriterionResult& finer) {
  const bool is_met = c.outcome == Verdict::hold;
  const std::string verb = is_met ? "met" : "not met";
  if (is_met && finer.outcome != Verdict::hold) return "met, but a finer run does not meet it";
  if (!is_met && finer.outcome == Verdict::hold) return "not met, but a finer run meets it";
  if (!c.value || !c.reserve) return "";
  if (!c.error || std::isnan(*c.error)) return verb + ", but its error is not known";
  const bool is_exactly_there = *c.reserve == 0.0 && finer.value && *finer.value == *c.value;
  if (std::abs(*c.reserve) >= *c.error || is_exactly_there) return "";
  return verb + ", but the error reaches the limit";
}

// --- slips in one of two runs only

// The earliest slip of an element that slips in only one of the two runs.
struct UnmatchedSlip {
  std::string element;
  double t = 0.0;
  bool is_mine = true;
};

std::vector<UnmatchedSlip> lone_slips(const RunResult& run, const RunResult& finer) {
  std::vector<UnmatchedSlip> found;
  const auto add = [&found](const UnmatchedSlip& slip) {
    const auto same = std::find_if(found.begin(), found.end(), [&](const UnmatchedSlip& other) { return other.element == slip.element; });
    if (same == found.end()) found.push_back(slip);
    else if (slip.t < same->t) *same = slip;
  };
  const EventMatch match = match_events(run.events, finer.events);
  for (const std::size_t i : match.only_mine)
    if (is_slip(run.events[i].kind)) add({run.events[i].element, run.events[i].t, true});
  for (const std::size_t i : match.only_reference)
    if (is_slip(finer.events[i].kind)) add({finer.events[i].element, finer.events[i].t, false});
  return found;
}

double spread_of(const ChannelRange* range) { return range ? range->high.value - range->low.value : 0.0; }

// Returns the largest range of the channels with this unit.
double largest_channel_range(const std::string& unit, const RunResult& run) {
  double largest = 0.0;
  for (const ChannelRange& range : run.ranges)
    if (range.channel->unit == unit && std::isfinite(spread_of(&range))) largest = std::max(largest, spread_of(&range));
  return largest;
}

// Returns true if a slid distance of the element differs clearly between the two runs. Friction of joints has no slid distance; its slip
// rate is compared instead.
bool changes_slide(const std::string& element, const System& system, const RunResult& run, const RunResult& finer) {
  double size = 0.0;
  for (const BodyData& body : system.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  const bool has_slide = find_range(run, element + ".slide") || find_range(run, element + ".dx");
  for (const char* part : {".slide", ".dx", ".dy", ".theta_acc", ".slip_rate"}) {
    const ChannelRange *mine = find_range(run, element + part), *theirs = find_range(finer, element + part);
    if (!mine || !theirs || (has_slide && std::string(part) == ".slip_rate")) continue;
    const std::string& unit = mine->channel->unit;
    const double negligible = std::max(k_slide_share * largest_channel_range(unit, run), k_size_share * (unit == "m" ? size : 1.0));
    const double larger = std::max(spread_of(mine), spread_of(theirs));
    if (std::abs(spread_of(mine) - spread_of(theirs)) > std::max(k_most_trusted_error * larger, negligible)) return true;
  }
  return false;
}

// Returns true if a criterion of the element is met in one of the two runs only.
bool changes_verdict(const std::string& element, const Judgement& judgement, const Judgement& finer) {
  for (const CriterionResult& mine : judgement.criteria)
    for (const CriterionResult& other : finer.criteria) {
      const bool is_same = mine.name == other.name && mine.text == other.text;
      if (is_same && (mine.where == element || other.where == element) && mine.outcome != other.outcome) return true;
    }
  return false;
}

// Returns a text on the first slip that only one run has and that matters. Without two agreeing references it is not known which run is
// right.
std::string doubt_about_slips(const Judgement& judgement, const Judgement& finer, const System& system, const RunResult& run,
                              const GlobalErrorEstimate& estimate) {
  for (const UnmatchedSlip& slip : lone_slips(run, estimate.finest)) {
    if (!changes_verdict(slip.element, judgement, finer) && !changes_slide(slip.element, system, run, estimate.finest)) continue;
    char t[32];
    std::snprintf(t, sizeof t, "%.6g", slip.t);
    const std::string what = "'" + slip.element + "' slips at t = " + t + " s ";
    if (!estimate.references.empty())
      return what + (slip.is_mine ? "here but not in runs by " : "in runs by ") + estimate.references +
             (slip.is_mine ? "" : " but not here") + ", which agree: the fixed steps are wrong; " + k_smaller_step;
    return what + (slip.is_mine ? "here but not in a finer run" : "in a finer run but not here") + ": try a smaller step or tolerance";
  }
  return "";
}

void take_over_open(Judgement& judgement) {
  for (const CriterionResult& c : judgement.criteria) {
    judgement.so_far = std::max(judgement.so_far, c.outcome);
    judgement.verdict = std::max(judgement.verdict, std::min(c.outcome, Verdict::open));
  }
}

std::string share_text(double share) {
  char text[48];
  std::snprintf(text, sizeof text, "%.2g %% of its range", 100.0 * share);
  return std::isnan(share) ? "unknown" : text;
}

} // namespace

void weigh_errors(Judgement& judgement, const Model& model, const System& system, const RunResult& run,
                  const GlobalErrorEstimate& estimate) {
  const Judgement finer = judge(model, system, estimate.finest, "");
  const auto twin = [&](std::size_t i) -> const CriterionResult* {
    const CriterionResult& mine = judgement.criteria[i];
    for (const CriterionResult& c : finer.criteria)
      if (c.name == mine.name && c.text == mine.text) return &c;
    return nullptr;
  };
  const std::string of_slips = doubt_about_slips(judgement, finer, system, run, estimate); // before outcomes are changed
  for (std::size_t i = 0; i < judgement.criteria.size(); ++i) {
    CriterionResult& c = judgement.criteria[i];
    set_errors(c, system, run, estimate);
    if (c.outcome == Verdict::open) continue;
    if (const CriterionResult* other = twin(i)) c.doubt = doubt_about(c, *other);
    else c.doubt = c.outcome == Verdict::hold ? "met, but a finer run cannot judge it" : "not met, but a finer run meets it";
    if (!c.doubt.empty() && c.outcome == Verdict::hold) c.outcome = Verdict::open;
  }
  take_over_open(judgement);
  distrust(judgement, of_slips);
  if (!estimate.reason_unknown.empty()) return leave_open(judgement, estimate.reason_unknown);
  const WorstError& worst = estimate.error.of(ErrorKind::position);
  if (worst.value <= k_most_trusted_error) return;
  if (!estimate.references.empty() && !std::isnan(worst.value))
    return distrust(judgement, "two runs by " + estimate.references + " agree, and this one is off by " + share_text(worst.value) +
                                   " in '" + worst.where + "': the fixed steps are wrong; " + k_smaller_step);
  distrust(judgement, "the estimated error of '" + worst.where + "' is " + share_text(worst.value) + ": try a smaller step or tolerance");
}

void leave_open(Judgement& judgement, const std::string& why) {
  for (CriterionResult& c : judgement.criteria) {
    if (c.value) c.error = k_unknown_error;
    if (c.outcome != Verdict::hold) continue;
    c.outcome = Verdict::open;
    c.doubt = "met, but its error is not known: " + why;
  }
  take_over_open(judgement);
}

} // namespace steplap
