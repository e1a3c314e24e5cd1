// Criteria against what was found.
#include "assess/assessment.h"

#include "mbd/base/shown_text.h"
#include "record/fields.h"
#include "run/quantity_text.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

std::string percent(double share) { return rounded_text(std::round(1e3 * share) / 10.0) + " %"; }

Decision outcome_of(const DecisionCriterion& c) { return c.outcome == "return" ? Decision::send_back : Decision::inspect; }

// The largest of what the recorder read, with where it was read.
struct Reading {
  double value = 0.0;
  std::size_t event = 0;
  char axis = 'x';
  bool is_known = true;
};

double value_of(const DecisionCriterion& c, const AxisEvent& axis) {
  if (c.quantity == "velocity_change") return std::abs(axis.velocity_change);
  return std::abs(c.bandwidth == "100 Hz" ? axis.at_cfc60 : c.bandwidth == "17 Hz" ? axis.at_cfc10 : axis.peak);
}

Reading largest_reading(const DecisionCriterion& c, const Assessment& a) {
  Reading largest;
  const char wanted = c.axis == "any" ? '\0' : c.axis.front();
  for (const RecordEvents& record : a.records)
    if (record.recording.layout.is_peaks || (wanted != '\0' && !record.axis(wanted))) largest.is_known = false;
  for (std::size_t e = 0; e < a.events.size(); ++e) {
    const RecordEvents& record = a.records[a.events[e].record];
    const ShockEvent& event = record.events[a.events[e].event].event;
    for (std::size_t i = 0; i < event.axes.size(); ++i) {
      if (wanted != '\0' && record.recording.layout.axes[i].axis != wanted) continue;
      const double value = value_of(c, event.axes[i]);
      if (std::isnan(value)) largest.is_known = false;
      else if (value > largest.value) largest.value = value, largest.event = e, largest.axis = record.recording.layout.axes[i].axis;
    }
  }
  for (const RecordEvents& record : a.records) // of a table of peaks at least that
    for (const PeakEntry& entry : record.recording.peaks)
      for (const double value : {entry.axis[0], entry.axis[1], entry.axis[2], entry.magnitude})
        if (c.quantity == "peak" && std::abs(value) > largest.value) largest.value = std::abs(value), largest.event = a.events.size();
  return largest;
}

// What a criterion makes of a number of which more may be known to be too much, or too little to be known.
Reason judged(const DecisionCriterion& c, Decision outcome, std::string text) {
  Reason reason{c.name, std::move(text), c.source, outcome, {}};
  if (outcome == Decision::inspect || outcome == Decision::send_back) reason.tests = c.tests;
  return reason;
}

Reason judge_reading(const DecisionCriterion& c, const Assessment& a) {
  const Reading largest = largest_reading(c, a);
  const bool is_peak = c.quantity == "peak";
  const auto shown = [&](double value) { return is_peak ? rounded_text(value / k_gravity, 3) + " g" : quantity_text(value, "m/s"); };
  const std::string band = !is_peak ? "" : c.bandwidth != "record" ? " up to " + c.bandwidth : largest.event < a.events.size() ? " up to " + rounded_text(a.records[a.events[largest.event].record].bandwidth, 3) + " Hz" : "";
  const std::string where = largest.event < a.events.size() ? " (axis " + std::string(1, largest.axis) + band + ", event " + std::to_string(largest.event + 1) + ")" : "";
  const std::string what = is_peak ? "The recorder read at most " : "The largest change of velocity is ";
  if (largest.value > *c.at_most) return judged(c, outcome_of(c), what + shown(largest.value) + where + ", more than " + shown(*c.at_most) + ".");
  if (!largest.is_known) return judged(c, Decision::open, "A record does not tell all that '" + c.name + "' asks: an axis, or frequencies that high, are not in it.");
  if (a.events.empty()) return judged(c, Decision::energise, "No sample is beyond the threshold of " + rounded_text(a.records.empty() ? 0.0 : a.records.front().rules.threshold / k_gravity, 3) + " g.");
  return judged(c, Decision::energise, what + shown(largest.value) + where + "; " + shown(*c.at_most) + " are allowed.");
}

Reason judge_flag(const DecisionCriterion& c, const VoyageSummary& s, bool happens, const std::string& yes, const std::string& no) {
  if (happens) return judged(c, outcome_of(c), yes);
  if (!s.unknown.empty()) return judged(c, Decision::open, "It is not known: " + s.unknown);
  return judged(c, Decision::energise, no);
}

Reason judge_acceptance(const DecisionCriterion& c, const VoyageSummary& s) {
  if (s.acceptance == Verdict::reject) return judged(c, Decision::send_back, "A model rejects the machine: " + s.first_unmet + ".");
  if (s.acceptance == Verdict::inspect) return judged(c, outcome_of(c), "A model asks to inspect the machine: " + s.first_unmet + ".");
  if (!s.unknown.empty()) return judged(c, Decision::open, "It is not known: " + s.unknown);
  if (s.acceptance == Verdict::open) return judged(c, Decision::open, "A model cannot say that the machine holds. " + s.first_unmet);
  return judged(c, Decision::energise, "All that the models ask is met in every event.");
}

Reason judge_probability(const DecisionCriterion& c, const Probability& p, const std::string& of) {
  if (p.runs == 0) return judged(c, Decision::open, "The probability of " + of + " is not known: no model says by [[uncertain]] what is not known exactly, or no samples were asked for.");
  const std::string text = "The probability of " + of + " is " + percent(p.value) + " (95 % interval " + percent(p.low) + " to " + percent(p.high) + ", " + std::to_string(p.runs) + " samples" +
                           (p.unknown > 0 ? ", " + std::to_string(p.unknown) + " of them without a result" : "") + "); " + percent(*c.at_most) + " are allowed";
  if (p.low > *c.at_most) return judged(c, outcome_of(c), text + ".");
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
  if (c.quantity == "peak" || c.quantity == "velocity_change") return judge_reading(c, a);
  if (c.quantity == "slip") return judge_flag(c, s, s.slips, s.first_slip.empty() ? "A joint slips." : s.first_slip + ".", "No joint slips in any event.");
  if (c.quantity == "comes_apart") return judge_flag(c, s, s.comes_apart, "A joint comes apart.", "No joint comes apart.");
  if (c.quantity == "lift") return judge_flag(c, s, s.lifts, "A contact lifts.", "No contact lifts.");
  if (c.quantity == "slid") return judge_flag(c, s, s.slid > *c.at_most, "A joint slid " + quantity_text(s.slid, "m") + " in all; " + quantity_text(*c.at_most, "m") + " are allowed.", "No joint slid further than " + quantity_text(s.slid, "m") + ".");
  if (c.quantity == "overlap_left") return judge_flag(c, s, s.overlap_left < *c.at_least, percent(s.overlap_left) + " of an overlap are left; " + percent(*c.at_least) + " are asked.", "Of every overlap at least " + percent(s.overlap_left) + " are left.");
  if (c.quantity == "margin") return judge_flag(c, s, s.least_margin < *c.at_least, "The least margin of a joint is " + rounded_text(s.least_margin, 3) + "; " + rounded_text(*c.at_least, 3) + " is asked.", "The least margin of a joint is " + rounded_text(s.least_margin, 3) + ".");
  if (c.quantity == "acceptance") return judge_acceptance(c, s);
  if (c.quantity == "slip_probability") return judge_probability(c, largest_slip(a), "slip in an event");
  return judge_probability(c, a.damage, "damage in the voyage");
}

// Of whatever the criteria say: what is not known forbids "energise".
void add_own(const Assessment& a, const VoyageSummary& s, std::vector<Reason>& reasons) {
  const auto open = [&](const char* name, const std::string& text) { reasons.push_back({name, text, "rules of this program", Decision::open, {}}); };
  for (const RecordEvents& record : a.records)
    for (const RecordFault fault : record.faults)
      if (std::find(a.accepted.begin(), a.accepted.end(), fault) == a.accepted.end())
        open("whole record", "'" + record.file + "' is not whole (" + name_of(fault) + "): what it does not show cannot be judged.");
  if (!s.unknown.empty()) open("runs to trust", "Not every event could be judged: " + s.unknown);
}

std::vector<Reason> reasons_of(const Assessment& a, const VoyageSummary& s) {
  std::vector<Reason> reasons;
  for (const DecisionCriterion& c : a.criteria.criteria) reasons.push_back(judge_criterion(c, a, s));
  add_own(a, s, reasons);
  std::stable_sort(reasons.begin(), reasons.end(), [](const Reason& x, const Reason& y) { return x.outcome > y.outcome; });
  return reasons;
}

} // namespace

Decision decision_of(const Assessment& assessment, const VoyageSummary& summary) {
  Decision worst = Decision::energise;
  for (const DecisionCriterion& c : assessment.criteria.criteria)
    if (!c.quantity.ends_with("probability")) worst = std::max(worst, judge_criterion(c, assessment, summary).outcome);
  std::vector<Reason> own;
  add_own(assessment, summary, own);
  for (const Reason& reason : own) worst = std::max(worst, reason.outcome);
  return worst;
}

void decide(Assessment& a) {
  a.reasons = reasons_of(a, a.summary);
  a.decision = a.reasons.empty() ? Decision::open : a.reasons.front().outcome;
  a.reason = a.decision == Decision::energise ? "All " + std::to_string(a.reasons.size()) + " criteria are met." : a.reasons.front().text;
  a.tests.clear();
  for (const Reason& reason : a.reasons)
    for (const std::string& test : reason.tests)
      if (std::find(a.tests.begin(), a.tests.end(), test) == a.tests.end()) a.tests.push_back(test);
}

} // namespace steplap::assess
