#include "transformer/verdict_error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

constexpr double k_most_trusted_error = 0.1; // of the range of positions

const ChannelError* find_error(const std::string& channel, const System& system, const GlobalErrorEstimate& estimate) {
  for (std::size_t c = 0; c < system.channels.size(); ++c)
    if (system.channels[c].name == channel) return &estimate.channels[c];
  return nullptr;
}

const ChannelRange* find_range(const std::string& channel, const RunResult& run) {
  for (const ChannelRange& range : run.ranges)
    if (range.channel->name == channel) return &range;
  return nullptr;
}

std::optional<double> event_error(const std::string& element, double t, const RunResult& run, const GlobalErrorEstimate& estimate) {
  for (std::size_t i = 0; i < run.events.size(); ++i)
    if (run.events[i].t == t && run.events[i].element == element) return estimate.event_times[i];
  return {};
}

void set_errors(CriterionResult& c, const System& system, const RunResult& run, const GlobalErrorEstimate& estimate) {
  const ChannelRange* range = find_range(c.channel, run);
  if (c.value && range) {
    const ChannelError& error = *find_error(c.channel, system, estimate);
    const bool is_low = *c.value == range->low.value;
    c.error = is_low ? error.low : error.high;
    if (c.t && *c.t == (is_low ? range->low.t : range->high.t)) c.t_error = is_low ? error.t_low : error.t_high;
  }
  if (!c.t || c.t_error) return;
  c.t_error = event_error(c.where, *c.t, run, estimate);
  if (!c.t_error && *c.t == 0.0) c.t_error = 0.0; // it slides from the start
  if (c.t_error) return;
  const ChannelError* usage = find_error(c.where + ".u", system, estimate); // of a joint that is only monitored
  c.t_error = usage ? usage->first_above_one : k_unknown_error;
}

// `finer`: the same criterion of a finer run.
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

JointErrors joint_errors(const JointAssessment& joint, const System& system, const RunResult& run,
                         const GlobalErrorEstimate& estimate) {
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
  if (!joint.first_slip) return e;
  const std::optional<double> at_event = event_error(joint.joint, *joint.first_slip, run, estimate);
  if (at_event) e.first_slip = *at_event;
  else if (joint.is_monitored) e.first_slip = of(".u", &ChannelError::first_above_one);
  else if (*joint.first_slip > 0.0) e.first_slip = of(".mode", &ChannelError::t_high);
  return e;
}

void weigh_errors(Judgement& judgement, const Model& model, const System& system, const RunResult& run,
                  const GlobalErrorEstimate& estimate) {
  const Judgement finer = judge(model, system, estimate.finest, "");
  const auto twin = [&](std::size_t i) -> const CriterionResult* {
    const CriterionResult& mine = judgement.criteria[i];
    for (const CriterionResult& c : finer.criteria)
      if (c.name == mine.name && c.text == mine.text) return &c;
    return nullptr;
  };
  for (std::size_t i = 0; i < judgement.criteria.size(); ++i) {
    CriterionResult& c = judgement.criteria[i];
    set_errors(c, system, run, estimate);
    if (c.outcome == Verdict::open) continue;
    if (const CriterionResult* other = twin(i)) c.doubt = doubt_about(c, *other);
    else c.doubt = c.outcome == Verdict::hold ? "met, but a finer run cannot judge it" : "not met, but a finer run meets it";
    if (!c.doubt.empty() && c.outcome == Verdict::hold) c.outcome = Verdict::open;
  }
  take_over_open(judgement);
  const WorstError& worst = estimate.error.of(ErrorKind::position);
  if (worst.value <= k_most_trusted_error) return;
  if (!judgement.distrust.empty()) judgement.distrust += "; ";
  judgement.distrust += "the estimated error of '" + worst.where + "' is " + share_text(worst.value) +
                        ": try a smaller step or tolerance";
  judgement.verdict = Verdict::open;
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
