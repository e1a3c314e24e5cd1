#include "mbd/run/overview.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/blows.h"
#include "mbd/run/prominence.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace steplap {

namespace {

constexpr double k_large_error = 0.01;       // largest error, relative to the range of a channel, that does not limit the trust
constexpr std::size_t k_longest_quote = 160; // largest number of characters of a quoted message

// Returns the first sentence of a message, shortened if it is long.
std::string first_sentence(const std::string& text) {
  std::string first = text.substr(0, text.find(". "));
  if (first.size() > k_longest_quote) first = first.substr(0, first.rfind(' ', k_longest_quote)) + " …";
  while (!first.empty() && first.back() == '.') first.pop_back();
  return first;
}

std::string quoted(const std::string& name) { return "'" + shown(name) + "'"; }

// --- the reason of a verdict

class VerdictReason {
public:
  VerdictReason(const Report& report, const Overview& overview, ShownDigits digits)
      : report_(report), overview_(overview), digits_(digits) {}

  std::string text() const {
    const Judgement& j = report_.judgement;
    if (report_.run.failure) {
      std::string text = "The run stopped at " + time(report_.run.result.final_state.t) +
                         ", before its end: " + first_sentence(report_.run.failure->text) + ".";
      if (j.so_far == Verdict::inspect || j.so_far == Verdict::reject) text += " Until then: " + unmet(j.so_far);
      return text;
    }
    if (!j.distrust.empty()) return "The run is not to be trusted: " + first_sentence(j.distrust) + ".";
    if (j.verdict == Verdict::reject || j.verdict == Verdict::inspect) return unmet(j.verdict);
    if (j.verdict == Verdict::open) return open();
    const std::size_t count = j.criteria.size();
    const std::string& ended_by = report_.run.result.ended_by;
    const std::string until =
        ended_by.empty() ? "" : " up to " + time(report_.run.result.final_state.t) + ", where action " + quoted(ended_by) + " ends the run";
    const std::string all = (count == 1 ? "The one criterion is met" : "All " + std::to_string(count) + " criteria are met") + until;
    const auto nearest =
        std::find_if(overview_.utilisations.begin(), overview_.utilisations.end(), [&](const Utilisation& u) { return is_criterion(u); });
    if (nearest == overview_.utilisations.end()) return all + ".";
    return all + "; nearest to its limit is " + quoted(nearest->name) + ", with " + shown_share(nearest->share, nearest->error, digits_) +
           ".";
  }

private:
  std::string time(double t) const {
    return shown_quantity(t, "s", {.scale = report_.run.result.final_state.t, .column = t < 1e-2 ? t : 1.0}, digits_);
  }

  bool is_criterion(const Utilisation& u) const {
    return std::any_of(report_.judgement.criteria.begin(), report_.judgement.criteria.end(),
                       [&](const CriterionResult& c) { return c.channel == u.channel; });
  }

  double share_of(const CriterionResult& c) const {
    for (const Utilisation& u : overview_.utilisations)
      if (u.channel == c.channel && c.limit && u.limit == c.limit) return u.share;
    return 1.0;
  }

  // Returns a sentence on the criterion that explains the verdict: the joint that slipped or came apart first, otherwise the highest
  // utilisation.
  std::string unmet(Verdict verdict) const {
    const CriterionResult* worst = nullptr;
    std::size_t count = 0;
    for (const CriterionResult& c : report_.judgement.criteria) {
      if (c.outcome != verdict) continue;
      ++count;
      const bool mine = joint_that_slid(c) != nullptr, theirs = worst && joint_that_slid(*worst) != nullptr;
      const bool is_earlier = mine && theirs && *joint_that_slid(c)->first_slip < *joint_that_slid(*worst)->first_slip;
      if (!worst || (mine && !theirs) || is_earlier || (!mine && !theirs && share_of(c) > share_of(*worst))) worst = &c;
    }
    if (!worst) return "A criterion is not met.";
    const std::string more = count > 1 ? " " + counted(count - 1, "more criterion is", "more criteria are") + " not met." : "";
    return sentence(*worst) + more;
  }

  const JointAssessment* joint_that_slid(const CriterionResult& c) const {
    const Channel* const channel = report_.run.loaded->system->find_channel(c.channel);
    if (!c.channel.empty() && !(channel && channel->role == ChannelRole::margin)) return nullptr;
    for (const JointAssessment& joint : report_.joints)
      if (joint.joint == c.name && joint.first_slip && (joint.has_slipped || joint.has_come_apart)) return &joint;
    return nullptr;
  }

  std::string sentence(const CriterionResult& c) const {
    if (const JointAssessment* joint = joint_that_slid(c)) {
      for (const StoryEntry& entry : overview_.story)
        if (entry.what == StorySubject::apart && entry.who.front() == joint->joint)
          return "Joint " + quoted(joint->joint) + " comes apart at " + time(entry.from) + ".";
      for (const StoryEntry& entry : overview_.story)
        if (entry.what == StorySubject::slips && entry.who.size() == 1 && entry.who.front() == joint->joint && entry.amount) {
          const std::string slid =
              shown_quantity(entry.amount->value, "m", {.error = entry.amount->error, .scale = k_least_length_scale}, digits_);
          if (slid.starts_with("0 ")) continue; // the corner rotates in place
          return "Joint " + quoted(joint->joint) + " slips at " + time(*joint->first_slip) + " and slides " + slid + ".";
        }
      return "Joint " + quoted(joint->joint) + " slips at " + time(*joint->first_slip) + ".";
    }
    const std::string at = c.t ? " at " + time(*c.t) : "";
    for (const StoryEntry& entry : overview_.story) // reason for a tie: it broke
      if (entry.what == StorySubject::breaks && c.name == c.where && entry.who.front() == c.where)
        return sentence_name(c.where) + " breaks" + at + ".";
    if (c.value && c.limit) {
      const bool is_below = std::abs(*c.value) < *c.limit || (*c.limit <= 0.0 && *c.value < *c.limit);
      const double column = std::max(std::abs(*c.value), std::abs(*c.limit));
      const std::string value =
          shown_quantity(*c.value, c.unit, {.error = c.error, .limit = c.limit, .scale = *c.limit, .column = column}, digits_);
      const std::string what = c.name == c.where ? aspect_name(c) : quoted(c.name);
      return what + (is_below ? " falls to " : " reaches ") + value + at + (is_below ? ", below its limit of " : ", beyond its limit of ") +
             shown_quantity(*c.limit, c.unit, {.column = column}, digits_) + ".";
    }
    return "There is an event that " + quoted(c.name) + " forbids: " + first_sentence(c.text) + " is asked, and it happens" + at + ".";
  }

  // Returns the name of an element's own criterion: "front joint: displacement".
  std::string aspect_name(const CriterionResult& c) const {
    for (const Utilisation& u : overview_.utilisations)
      if (u.channel == c.channel && u.limit == c.limit) return quoted(u.name);
    return quoted(c.name) + " (" + c.text + ")";
  }

  std::string open() const {
    const Judgement& j = report_.judgement;
    if (!j.has_criteria) return "The model has no criteria: it has no [[acceptance]] by which to judge the run.";
    for (const CriterionResult& c : j.criteria)
      if (c.outcome == Verdict::open)
        return quoted(c.name) +
               (c.doubt.empty() ? " could not be judged: " + first_sentence(c.text) + "." : " is " + first_sentence(c.doubt) + ".");
    return "Every criterion is met, but the run cannot mean \"hold\": " + first_sentence(j.caps.empty() ? "" : j.caps.front()) + ".";
  }

  const Report& report_;
  const Overview& overview_;
  ShownDigits digits_;
};

// --- trust

// Returns the largest known error of channels with this unit; NaN if none is known.
double largest_error(const Report& report, const std::string& unit) {
  double largest = std::nan("");
  for (const ChannelRange& range : report.ranges()) {
    if (range.channel->unit != unit) continue;
    for (const auto which : {&ChannelError::low, &ChannelError::high})
      if (const auto error = report.error_of(range, which); error && std::isfinite(*error))
        largest = std::isnan(largest) ? *error : std::max(largest, *error);
  }
  return largest;
}

// Returns channels with an extreme whose error is unknown, for example where a reaction diverges.
std::vector<std::string> channels_without_error(const Report& report) {
  std::vector<std::string> names;
  for (const ChannelRange& range : report.ranges()) {
    const auto is_unknown = [&](const Extreme& extreme, double ChannelError::*which) {
      const auto error = report.error_of(range, which);
      return std::isfinite(extreme.value) && error && !std::isfinite(*error);
    };
    if (is_unknown(range.low, &ChannelError::low) || is_unknown(range.high, &ChannelError::high)) names.push_back(range.channel->name);
  }
  return names;
}

// Formats an error, rounded up: "3 N", "better than 1 µm".
std::string error_text(double error, const std::string& unit) {
  const double floor = unit == "N" ? 1e-3 : unit == "m" ? 1e-9 : 1e-9; // lowest error shown (mN, nm, ns): more accuracy is never required
  if (error <= floor) return "better than " + std::string(unit == "N" ? "1 mN" : unit == "m" ? "0.001 µm" : "0.001 µs");
  return shown_quantity(error, unit, {}, {.most = 1});
}

void add_part(std::string& list, const std::string& what, double error, const std::string& unit) {
  if (std::isnan(error)) return;
  list += (list.empty() ? "" : ", ") + what + " to " + error_text(error, unit);
}

Trust trust_by_errors(const Report& report) {
  const GlobalErrorEstimate& estimate = *report.estimate.errors;
  if (!estimate.reason_unknown.empty())
    return {TrustLevel::limited, "The errors are not known: " + first_sentence(estimate.reason_unknown) + "."};
  double time_error = std::nan("");
  std::size_t unknown = 0;
  const std::vector<Event>& events = report.run.result.events;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (!is_main_event(events[i])) continue;
    const double error = estimate.event_times[i];
    if (std::isnan(time_error)) time_error = 0.0;
    if (std::isfinite(error)) time_error = std::max(time_error, error);
    else ++unknown;
  }
  std::string parts;
  add_part(parts, "times", time_error, "s");
  add_part(parts, "forces", largest_error(report, "N"), "N");
  add_part(parts, "places", largest_error(report, "m"), "m");
  Trust trust{TrustLevel::good, !estimate.references.empty() ? "Errors are estimated by adaptive runs"
                                : estimate.finer.size() > 1  ? "Errors are estimated by finer runs"
                                                             : "Errors are estimated by a finer run"};
  trust.text += parts.empty() ? "." : ": " + parts + ".";
  const double worst = estimate.error.of(ErrorKind::position).value;
  const WorstError& reaction = estimate.error.of(ErrorKind::reaction);
  const bool has_large = worst > k_large_error || reaction.value > k_large_error;
  // at rest no channel has a range to which errors could be related
  if (has_large && !is_at_rest(report.run)) trust.level = TrustLevel::limited;
  if (const std::vector<std::string> names = channels_without_error(report); !names.empty()) {
    trust.level = TrustLevel::limited;
    trust.text += names.size() == 1 ? " That of " + quoted(names.front()) + " is not known."
                                    : " Those of " + counted(names.size(), "channel", "channels") + ", such as " + quoted(names.front()) +
                                          ", are not known.";
  }
  const std::size_t lone = estimate.error.unmatched_events > 0 ? static_cast<std::size_t>(estimate.error.unmatched_events) : unknown;
  if (lone == 0) return trust;
  trust.level = TrustLevel::limited;
  trust.text += " " + counted(lone, "event is", "events are") + " in one of the runs only.";
  return trust;
}

std::string second_method(const SecondOpinion& second) {
  return second.method.substr(0, second.method.find_first_of(" @")) + (second.drawn_step > 0.0 ? " in steps drawn at random" : "");
}

// Returns the names of the checks that were made, whatever their result. All checks that a method makes at each step count as one.
std::vector<std::string> guards_of(const Report& report) {
  std::vector<std::string> guards = {"energy balance"};
  if (!report.run.loaded->system->rows.empty()) guards.emplace_back("joints");
  if (!report.run.failure && report.judgement.has_criteria && !report.ranges().empty()) guards.emplace_back("loads");
  const Estimate& estimate = report.estimate;
  if (estimate.errors)
    guards.emplace_back(!estimate.errors->references.empty() ? "adaptive runs"
                        : estimate.errors->finer.size() > 1  ? "finer runs"
                                                             : "finer run");
  if (estimate.errors && estimate.balance_unknown.empty()) guards.emplace_back("nudges");
  if (report.second_opinion && report.second_opinion->none_because.empty()) guards.push_back(second_method(*report.second_opinion));
  return guards;
}

Trust trust_of(const Report& report) {
  if (report.run.failure) return {TrustLevel::none, "The run did not reach its end: what there is holds up to there only."};
  if (!report.judgement.distrust.empty())
    return {TrustLevel::none, "Do not use these numbers: " + first_sentence(report.judgement.distrust) + "."};
  if (report.estimate.errors) {
    Trust trust = trust_by_errors(report);
    const auto doubtful = std::count_if(report.judgement.criteria.begin(), report.judgement.criteria.end(), [](const CriterionResult& c) {
      return !c.doubt.empty() && !c.doubt.starts_with(k_but_for_a_blow);
    });
    if (doubtful > 0) trust.level = TrustLevel::limited;
    const std::optional<SecondOpinion>& second = report.second_opinion;
    if (second && second->disagreement.empty() && second->none_because.empty())
      trust.text += " A second method, " + second_method(*second) + ", agrees.";
    return trust;
  }
  if (report.estimate.status == EstimateStatus::too_expensive)
    return {TrustLevel::limited, "Errors are estimated on request only, since that takes long."};
  return {TrustLevel::limited, "Errors are not estimated: " + first_sentence(report.estimate.reason) + "."};
}

} // namespace

const char* name_of(TrustLevel level) { return level == TrustLevel::good ? "good" : level == TrustLevel::limited ? "limited" : "none"; }

Overview overview_of(const Report& report, ShownDigits digits) {
  const RangeIndex ranges(report.ranges());
  Overview overview;
  overview.verdict = report.judgement.verdict;
  overview.is_judged = report.judgement.has_criteria || !report.judgement.distrust.empty() || report.run.failure;
  overview.story = story_of(report, ranges, digits);
  overview.utilisations = utilisations_of(report, ranges, digits);
  const auto judged = std::find_if(overview.utilisations.begin(), overview.utilisations.end(),
                                   [](const Utilisation& u) { return u.criterion.has_value(); });
  if (judged != overview.utilisations.end()) overview.worst_instant = judged->at;
  else if (!overview.utilisations.empty()) overview.worst_instant = overview.utilisations.front().at;
  overview.trust = trust_of(report);
  overview.trust.guards = guards_of(report);
  std::unordered_set<std::string> known;
  for (const StoryEntry& entry : overview.story)
    if (describes_motion(entry))
      for (const std::string& name : entry.who)
        if (known.insert(name).second) overview.moved.push_back(name);
  overview.reason = VerdictReason(report, overview, digits).text();
  return overview;
}

} // namespace steplap
