// Applies the criteria to the results.
#include "tools/assess/assessment.h"

#include "mbd/base/shown_text.h"
#include "mbd/run/quantity_text.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap::assess {

namespace {

std::string percent(double share) { return rounded_text(std::round(1e3 * share) / 10.0) + " %"; }

Decision outcome_of(const DecisionCriterion& c) { return c.outcome == "return" ? Decision::send_back : Decision::inspect; }

// Largest value of a quantity in the records, and where it was measured.
struct Reading {
  double value = 0.0;
  std::size_t event = k_no_event;
  char axis = 'x';
  double bandwidth = 0.0; ///< bandwidth of the record, Hz
  bool is_known = true;
  bool may_be_exceeded_below = false; ///< true if shocks below the event threshold might exceed the limit, because they were not searched
  static constexpr std::size_t k_no_event = static_cast<std::size_t>(-1);
};

constexpr double k_least_bandwidth = 95.0; // smallest useful bandwidth for peaks, Hz; with less, one impact can read 18 g or 1.5 g

// Returns true if the criterion must be applied to the unfiltered rows: no filter was applied, or one whose bandwidth is too small for
// peaks.
bool applies_to_rows(const DecisionCriterion& c, const RecordEvents& record) {
  return c.quantity == "peak" && c.bandwidth == "record" && (!record.is_filtered || record.bandwidth < k_least_bandwidth);
}

double value_of(const DecisionCriterion& c, const AxisEvent& axis) {
  if (c.quantity == "velocity_change") return axis.largest_change;
  return std::abs(c.bandwidth == "100 Hz" ? axis.at_cfc60 : c.bandwidth == "17 Hz" ? axis.at_cfc10 : axis.peak);
}

// Returns the largest magnitude of an axis in the unfiltered rows, without offset, m/s².
double largest_row(const RecordEvents& record, std::size_t axis) {
  const AxisFacts& facts = record.recording.facts.axes[axis];
  return std::max(std::abs(facts.greatest - record.offset[axis]), std::abs(facts.least - record.offset[axis]));
}

std::size_t event_of_row(const Assessment& a, std::size_t record, std::size_t axis) {
  std::size_t best = Reading::k_no_event;
  double most = -1.0;
  for (std::size_t e = 0; e < a.events.size(); ++e)
    if (a.events[e].record == record)
      for (const double value : a.records[record].events[a.events[e].event].window.plain[axis])
        if (std::abs(value) > most) most = std::abs(value), best = e;
  // the peak of an event is up to 2 % smaller than that of the rows because of resampling
  return most >= 0.98 * largest_row(a.records[record], axis) ? best : Reading::k_no_event;
}

void take(Reading& largest, double value, std::size_t event, char axis, double bandwidth) {
  if (std::isnan(value)) largest.is_known = false;
  else if (value > largest.value) largest.value = value, largest.event = event, largest.axis = axis, largest.bandwidth = bandwidth;
}

void check_record(const DecisionCriterion& c, const Assessment& a, std::size_t r, Reading& largest) {
  const RecordEvents& record = a.records[r];
  const std::vector<AxisColumn>& axes = record.recording.layout.axes;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (c.axis != "any" && axes[i].axis != c.axis.front()) continue;
    if (applies_to_rows(c, record)) {
      take(largest, largest_row(record, i), event_of_row(a, r, i), axes[i].axis, 0.5 * record.rate);
      continue;
    }
    for (std::size_t e = 0; e < a.events.size(); ++e)
      if (a.events[e].record == r)
        take(largest, value_of(c, record.events[a.events[e].event].event.axes[i]), e, axes[i].axis, record.bandwidth);
    largest.may_be_exceeded_below |= c.quantity == "peak" && record.rules.threshold > *c.at_most && largest_row(record, i) > *c.at_most;
  }
}

Reading largest_reading(const DecisionCriterion& c, const Assessment& a) {
  constexpr std::size_t k_axes = 3;
  Reading largest;
  for (std::size_t r = 0; r < a.records.size(); ++r) {
    const RecordLayout& layout = a.records[r].recording.layout;
    if (layout.is_peaks || (c.axis != "any" ? !a.records[r].axis(c.axis.front()) : layout.axes.size() < k_axes)) largest.is_known = false;
    if (!layout.is_peaks) check_record(c, a, r, largest);
    // the bandwidth of a list of peaks is unknown, so its peaks count for every bandwidth
    for (const PeakEntry& entry : a.records[r].recording.peaks)
      for (const double value : {entry.axis[0], entry.axis[1], entry.axis[2], entry.magnitude})
        if (c.quantity == "peak" && std::abs(value) > largest.value) largest.value = std::abs(value), largest.event = Reading::k_no_event;
  }
  return largest;
}

// Creates the reason of a criterion that is violated, or of one that cannot be decided.
Reason judged(const DecisionCriterion& c, Decision outcome, std::string text, double excess = 0.0) {
  Reason reason{c.name, std::move(text), c.source, outcome, {}, excess};
  if (outcome == Decision::inspect || outcome == Decision::send_back) reason.tests = c.tests;
  return reason;
}

Reason judge_reading(const DecisionCriterion& c, const Assessment& a) {
  const Reading largest = largest_reading(c, a);
  const bool is_peak = c.quantity == "peak", has_event = largest.event < a.events.size();
  const auto shown = [&](double value) { return is_peak ? rounded_text(value / k_gravity, 3) + " g" : quantity_text(value, "m/s"); };
  const std::string band = !is_peak                  ? ""
                           : c.bandwidth != "record" ? ", up to " + c.bandwidth
                           : largest.bandwidth > 0.0 ? ", up to " + rounded_text(largest.bandwidth, 3) + " Hz"
                                                     : "";
  const std::string where = largest.bandwidth > 0.0 ? " (axis " + std::string(1, largest.axis) + band +
                                                          (has_event ? ", event " + std::to_string(largest.event + 1) : "") + ")"
                                                    : "";
  const std::string what = is_peak ? "The recorder read at most " : "The largest change of velocity is ";
  if (largest.value > *c.at_most)
    return judged(c, outcome_of(c), what + shown(largest.value) + where + ", more than " + shown(*c.at_most) + ".",
                  largest.value / *c.at_most);
  const auto is_list = [](const RecordEvents& record) { return record.recording.layout.is_peaks; };
  if (!largest.is_known && std::any_of(a.records.begin(), a.records.end(), is_list))
    return judged(c, Decision::open,
                  "A list of peaks does not say up to which frequency it was measured, nor what it left out, so '" + c.name +
                      "' cannot be met by it.");
  if (!largest.is_known)
    return judged(c, Decision::open, "The records lack data that '" + c.name + "' requires: an axis, or high frequencies.");
  if (largest.may_be_exceeded_below)
    return judged(c, Decision::open,
                  "Shocks above " + shown(*c.at_most) +
                      " may lie below the threshold from which shocks are looked at. Lower the threshold.");
  return judged(c, Decision::energise, what + shown(largest.value) + where + "; " + shown(*c.at_most) + " are allowed.");
}

// Returns the reason why criteria on joints cannot be evaluated; "" if they can.
std::string joints_unknown(const Assessment& a) {
  bool has_joints = false;
  for (const VoyageEvent& event : a.events)
    for (const Passage& passage : event.passages) {
      has_joints |= !passage.joints.empty();
      if (!passage.unjudged.empty())
        return "the joint '" + passage.unjudged.front() + "' has no sheets that overlap, and cannot be judged.";
    }
  return has_joints ? "" : "no model has a joint that can be judged.";
}

// Returns the reason why criteria on runs cannot be evaluated, for example because a record drove no model; "" if they can.
std::string runs_unknown(const Assessment& a) {
  for (const RecordEvents& record : a.records)
    if (record.recording.layout.is_peaks && !record.pulse)
      return "'" + record.file + "' holds peaks without a waveform, and no model was driven by them: a pulse can be assumed.";
  return a.events.empty() ? "no model was driven by a record." : "";
}

std::string unknown_of(const DecisionCriterion& c, const Assessment& a, const VoyageSummary& s) {
  if (!s.unknown.empty()) return s.unknown;
  if (const std::string waves = runs_unknown(a); !waves.empty()) return waves;
  return c.quantity == "acceptance" || c.quantity == "lift" ? "" : joints_unknown(a);
}

Reason judge_flag(const DecisionCriterion& c, const std::string& unknown, bool happens, double excess, const std::string& yes,
                  const std::string& no) {
  if (happens) return judged(c, outcome_of(c), yes, excess);
  if (!unknown.empty()) return judged(c, Decision::open, "It is not known: " + unknown);
  return judged(c, Decision::energise, no);
}

// Returns `all`, the reason from all limits. If it is "return" only because of assumed limits, it becomes "inspect". `known` is the reason
// from the other limits.
Reason without_assumed_return(Reason all, Reason known) {
  if (all.outcome != Decision::send_back) return all;
  if (known.outcome == Decision::send_back) return known;
  all.outcome = Decision::inspect;
  all.excess = std::numeric_limits<double>::infinity(); // placed first among reasons to inspect, because it would otherwise be a "return"
  all.text += " The limit is assumed, and no other requires \"return\": find out the true limit before the machine is sent back.";
  return all;
}

Reason judge_limits(const DecisionCriterion& c, const LimitsSummary& worst, const std::string& unknown) {
  if (worst.outcome == Verdict::reject)
    return judged(c, Decision::send_back, "A model rejects the machine: " + worst.unmet + ".", worst.share);
  if (worst.outcome == Verdict::inspect)
    return judged(c, outcome_of(c), "A model asks to inspect the machine: " + worst.unmet + ".", worst.share);
  if (!unknown.empty()) return judged(c, Decision::open, "It is not known: " + unknown);
  if (worst.outcome == Verdict::open) return judged(c, Decision::open, "A model cannot say that the machine holds. " + worst.unmet);
  return judged(c, Decision::energise, "All that the models ask is met in every event.");
}

Reason judge_acceptance(const DecisionCriterion& c, const VoyageSummary& s, const std::string& unknown) {
  return without_assumed_return(judge_limits(c, s.limits, unknown), judge_limits(c, s.known_limits, unknown));
}

Reason judge_probability(const DecisionCriterion& c, const Probability& p, const std::string& of, const std::string& waves) {
  if (!waves.empty()) return judged(c, Decision::open, "The probability of " + of + " is not known: " + waves);
  if (p.runs == 0)
    return judged(c, Decision::open,
                  "The probability of " + of + " is not known: no model has [[uncertain]] values, or no samples were requested.");
  const std::string text = "The probability of " + of + " is " + percent(p.value) + " (95 % interval " + percent(p.low) + " to " +
                           percent(p.high) + ", " + std::to_string(p.runs) + " samples" +
                           (p.unknown > 0 ? ", " + std::to_string(p.unknown) + " of them without a result" : "") + "); " +
                           percent(*c.at_most) + " are allowed";
  // excess 1 places it after the single criteria, which it summarises
  if (p.low > *c.at_most) return judged(c, outcome_of(c), text + ".", 1.0);
  if (p.high > *c.at_most) return judged(c, Decision::open, text + ", which lies within the interval: more samples are needed.");
  return judged(c, Decision::energise, text + ".");
}

Probability largest_slip(const Assessment& a) {
  Probability worst;
  for (const VoyageEvent& event : a.events)
    for (const Probability& p : event.slip)
      if (worst.runs == 0 || p.high > worst.high) worst = p;
  return worst;
}

Reason judge_criterion(const DecisionCriterion& c, const Assessment& a, const VoyageSummary& s) {
  if (c.basis == CriterionBasis::reading) return judge_reading(c, a);
  const std::string unknown = unknown_of(c, a, s);
  // demand over capacity of the joint nearest to slip; NaN: unknown
  const double demand = s.least_margin >= 0.0 ? 1.0 / s.least_margin : 0.0;
  if (c.quantity == "slip")
    return judge_flag(c, unknown, s.slips, demand, s.first_slip.empty() ? "A joint slips." : s.first_slip + ".",
                      "No joint slips in any event.");
  if (c.quantity == "comes_apart") return judge_flag(c, unknown, s.comes_apart, demand, "A joint comes apart.", "No joint comes apart.");
  if (c.quantity == "lift") return judge_flag(c, unknown, s.lifts, 0.0, "A contact lifts.", "No contact lifts.");
  if (c.quantity == "slid")
    return judge_flag(c, unknown, s.slid > *c.at_most, s.slid / *c.at_most,
                      "A joint slid " + quantity_text(s.slid, "m") + " in all; " + quantity_text(*c.at_most, "m") + " are allowed.",
                      "No joint slid further than " + quantity_text(s.slid, "m") + ".");
  if (c.quantity == "overlap_left")
    return judge_flag(c, unknown, s.overlap_left < *c.at_least, *c.at_least / s.overlap_left,
                      percent(s.overlap_left) + " of an overlap remain; " + percent(*c.at_least) + " are required.",
                      "Of every overlap at least " + percent(s.overlap_left) + " are left.");
  if (c.quantity == "margin")
    return judge_flag(c, unknown, s.least_margin < *c.at_least, *c.at_least * demand,
                      "The least margin of a joint is " + rounded_text(s.least_margin, 3) + "; " + rounded_text(*c.at_least, 3) +
                          " is required.",
                      "The least margin of a joint is " + rounded_text(s.least_margin, 3) + ".");
  if (c.quantity == "acceptance") return judge_acceptance(c, s, unknown);
  if (c.quantity == "slip_probability") return judge_probability(c, largest_slip(a), "slip in an event", runs_unknown(a));
  const std::string of = "damage in the voyage", waves = runs_unknown(a);
  return without_assumed_return(judge_probability(c, a.damage, of, waves), judge_probability(c, a.known_damage, of, waves));
}

// Judges frictions shared by two planes. Friction is one vector, but each model judges only the component in its own plane.
Reason judge_shared_friction(const VoyageSummary& s) {
  const char* const name = "friction of several planes";
  const char* const source = "rules of this program";
  if (s.planes_slip.empty())
    return {name,   "The planes together ask for at most " + percent(s.planes_use) + " of a friction that they share.",
            source, Decision::energise,
            {},     s.planes_use};
  const Decision outcome = s.planes == Verdict::hold ? Decision::energise : s.planes == Verdict::open ? Decision::open : Decision::inspect;
  return {name, s.planes_slip, source, outcome, {}, s.planes_use};
}

// The less favourable decision of two recorders counts.
Reason judge_second(const RecorderFindings& second) {
  const std::string file = "'" + second.files.front() + "'";
  return {"second recorder",
          "The second recorder, " + file + ", leads to \"" + name_of(second.decision) + "\": " + second.reason,
          "rules of this program",
          second.decision,
          second.tests,
          0.0};
}

// Adds reasons that are not criteria of the file: for example, missing evidence prevents "energise".
void add_rules_of_program(const Assessment& a, const VoyageSummary& s, std::vector<Reason>& reasons) {
  const auto open = [&](const char* name, const std::string& text) {
    reasons.push_back({name, text, "rules of this program", Decision::open, {}, 0.0});
  };
  for (const MissingEvidence& missing : a.missing)
    if (!a.is_accepted(missing.item))
      open("evidence",
           missing.reason + " " + missing.remedy + " (accept " + name_of(missing.item) + " puts the responsibility on the user.)");
  if (!a.shared.empty()) reasons.push_back(judge_shared_friction(s));
  if (!a.recorders.empty()) reasons.push_back(judge_second(a.recorders.back()));
  if (!s.unknown.empty()) open("runs to trust", "Not every event could be judged: " + s.unknown);
}

std::vector<Reason> reasons_of(const Assessment& a, const VoyageSummary& s) {
  std::vector<Reason> reasons;
  for (const DecisionCriterion& c : a.criteria.criteria) reasons.push_back(judge_criterion(c, a, s));
  add_rules_of_program(a, s, reasons);
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Reason& x, const Reason& y) { return x.outcome != y.outcome ? x.outcome > y.outcome : x.excess > y.excess; });
  return reasons;
}

} // namespace

Decision decision_by_criteria(const Assessment& assessment, const VoyageSummary& summary) {
  Decision worst = Decision::energise;
  for (const DecisionCriterion& c : assessment.criteria.criteria)
    if (c.basis != CriterionBasis::probability) worst = std::max(worst, judge_criterion(c, assessment, summary).outcome);
  return worst;
}

Decision decision_of(const Assessment& assessment, const VoyageSummary& summary) {
  Decision worst = decision_by_criteria(assessment, summary);
  std::vector<Reason> own;
  add_rules_of_program(assessment, summary, own);
  for (const Reason& reason : own) worst = std::max(worst, reason.outcome);
  return worst;
}

void decide(Assessment& a) {
  a.reasons = reasons_of(a, a.summary);
  a.decision = a.reasons.empty() ? Decision::open : a.reasons.front().outcome;
  a.reason = a.decision == Decision::energise ? "All " + std::to_string(a.reasons.size()) + " criteria are met. " + coverage_text(a.records)
                                              : a.reasons.front().text;
  const auto is_open = [&](const MissingEvidence& missing) { return !a.is_accepted(missing.item); };
  if (a.decision == Decision::inspect && std::any_of(a.missing.begin(), a.missing.end(), is_open))
    a.reason += " Evidence is missing, and what it would show may be worse.";
  a.tests.clear();
  const auto add = [&](const std::vector<std::string>& tests) {
    for (const std::string& test : tests)
      if (std::find(a.tests.begin(), a.tests.end(), test) == a.tests.end()) a.tests.push_back(test);
  };
  for (const Reason& reason : a.reasons) add(reason.tests);
  add(a.criteria.tests);
}

} // namespace steplap::assess
