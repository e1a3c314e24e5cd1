#include "tools/assess/voyage_evidence.h"

#include "mbd/base/shown_text.h"
#include "tools/assess/record_evidence.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap::assess {

namespace {

// Smallest reliable margin for a recorder on the tank's lid. Even if the tank does not rotate, this position causes errors of up to 45 % in
// the pressure that joints require, in either direction (docs/evidence/recorders.md).
constexpr double k_lid_margin = 1.5;

void find_axes(Assessment& a) {
  const std::string used = axes_used(a.models);
  for (const RecordEvents& record : a.records) {
    if (record.recording.layout.is_peaks) continue;
    const std::string axes = record.axes();
    const auto is_used = [&](std::size_t i) { return used.find(axes[i]) != std::string::npos; };
    double seen = 0.0; // largest acceleration along axes that drive models, m/s²
    for (std::size_t i = 0; i < axes.size(); ++i)
      if (is_used(i)) seen = std::max(seen, record.greatest[i]);
    // The largest reading of an axis that drives no model must be below a shock, or below a quarter of one if it exceeds half of `seen`, as
    // for a recorder that was turned by 27° or more. Its mean must stay below a quarter of a shock whatever the other axes read: braking and
    // curves push for seconds.
    constexpr double k_turned = 0.25, k_half = 0.5;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      const double level = shock_level(record.rules), most = record.greatest[i];
      const bool is_shock = most > (most > k_half * seen ? k_turned : 1.0) * level, is_sustained = record.sustained[i] > k_turned * level;
      if (is_used(i) || !(is_shock || is_sustained)) continue;
      a.missing.push_back({Evidence::axis,
                           "Axis " + std::string(1, axes[i]) + " of '" + record.file + "' reads up to " +
                               rounded_text(most / k_gravity, 3) + " g" +
                               (is_shock ? "" : ", " + rounded_text(record.sustained[i] / k_gravity, 2) + " g in the mean over 0.2 s,") +
                               " and drives no model: what these shocks did is not known.",
                           "Give a model of that plane, or correct the axes of [[recorder]] if the recorder was turned."});
    }
    constexpr std::size_t k_axes = 3;
    if (axes.size() < k_axes)
      a.missing.push_back({Evidence::axis,
                           "'" + record.file + "' has " + (axes.size() == 1 ? "one axis" : "two axes") +
                               " of three: shocks along the others were not seen.",
                           "Read all three axes."});
  }
}

double class_of(double bandwidth) {
  // Converts the −3 dB frequency of the filter to its class (CFC): the ratio is 1.667 (transformer/recorder/filter.h).
  return bandwidth / (ChannelFilter::k_ratio * std::pow(std::sqrt(2.0) - 1.0, 0.25));
}

// Repeats the filtering of all records with `factor` times the corner frequency. Returns false if the sampling rate does not permit it.
bool refilter(Assessment& other, double factor) {
  for (RecordEvents& record : other.records) {
    if (record.recording.layout.is_peaks) continue;
    double frequency_class = class_of(factor * record.bandwidth);
    const double highest = 0.1 * record.rate * (1.0 - 1e-9); // largest corner frequency of the filter, Hz
    const bool is_whole = frequency_class > highest;
    if (is_whole && factor > 1.0 && !record.is_filtered) return false;
    if (is_whole && factor < 1.0) frequency_class = highest;
    for (RecordedEvent& event : record.events) {
      for (std::size_t i = 0; i < record.recording.layout.axes.size(); ++i) {
        event.window.filtered[i] = event.window.plain[i];
        if (!is_whole || factor < 1.0) ChannelFilter(frequency_class, record.rate).apply(event.window.filtered[i]);
      }
      event.event.axes = describe_event(event.window, record.recording.layout.axes.size()).axes;
    }
  }
  return true;
}

std::vector<std::vector<DriveHistory>> histories_of(const Assessment& a, const std::vector<RecordEvents>& records) {
  std::vector<std::vector<DriveHistory>> all;
  for (const DrivenModel& model : a.models) {
    std::vector<DriveHistory>& histories = all.emplace_back();
    for (const VoyageEvent& event : a.events)
      histories.push_back(
          drive_history(records[event.record], records[event.record].events[event.event], model.recorder, model.marker_angle));
  }
  return all;
}

void find_bandwidth(const AssessmentOptions& options, Assessment& a) {
  const bool is_known =
      std::any_of(a.missing.begin(), a.missing.end(), [](const MissingEvidence& m) { return m.item == Evidence::bandwidth; });
  if (is_known || a.events.empty()) return;
  double lowest = 0.0;
  for (const RecordEvents& record : a.records)
    if (!record.recording.layout.is_peaks) lowest = lowest == 0.0 ? record.bandwidth : std::min(lowest, record.bandwidth);
  if (lowest == 0.0) return; // assumed pulses have no bandwidth
  const auto open = [&](const std::string& what) {
    a.missing.push_back(
        {Evidence::bandwidth,
         "The decision depends on the frequencies that are looked at, up to " + rounded_text(lowest, 3) + " Hz: " + what + ".",
         "Give a record with more samples per second, or a higher frequency class."});
  };
  for (const double factor : {0.5, 2.0}) {
    Assessment other;
    other.records = a.records;
    if (!refilter(other, factor)) continue;
    const std::vector<std::vector<DriveHistory>> histories = histories_of(a, other.records);
    const VoyageSummary summary = voyage_with(a.models, histories, *a.uncertain, a.uncertain->nominal(), a.shared).summary;
    const std::string where = std::string("with ") + (factor < 1.0 ? "half" : "twice") + " the bandwidth it is ";
    std::swap(a.records, other.records); // criteria on readings are applied to those of the other bandwidth
    const Decision decision = decision_by_criteria(a, summary);
    std::swap(a.records, other.records);
    if (decision != Decision::energise) return open(where + "\"" + name_of(decision) + "\"");
    if (factor > 1.0 && a.damage.runs > 0) {
      SamplingOptions sampling = options.sampling;
      sampling.stop = options.stop;
      sampling.store.clear();
      const Probability damage = damage_probability(sample_voyages(a.models, histories, *a.uncertain, sampling, a.shared));
      for (const DecisionCriterion& c : a.criteria.criteria)
        if (c.quantity == "damage_probability" && damage.high > *c.at_most)
          return open(where + "not, as the probability of damage is " + rounded_text(100.0 * damage.value, 3) + " %");
    }
    // Frequencies above half the sampling rate of an unfiltered record are unknown. Their effect on the margin is assumed to equal that of
    // the last halving of the bandwidth.
    const bool can_double = std::any_of(a.records.begin(), a.records.end(), [](const RecordEvents& r) { return r.is_filtered; });
    if (factor < 1.0 && !can_double && a.summary.least_margin < summary.least_margin &&
        a.summary.least_margin * a.summary.least_margin < summary.least_margin)
      return open("half of them raise the least margin from " + rounded_text(a.summary.least_margin, 3) + " to " +
                  rounded_text(summary.least_margin, 3) + ", and twice as many may take it below 1");
  }
}

void find_place(Assessment& a) {
  if (!(a.summary.least_margin < k_lid_margin)) return;
  for (const DrivenModel& model : a.models)
    if (model.recorder.mounted == "lid")
      return a.missing.push_back(
          {Evidence::place,
           "The least margin of a joint is " + rounded_text(a.summary.least_margin, 3) + ", and the recorder of '" + model.name +
               "' sits on the lid: there a margin below 1.5 is not known.",
           "Give a record from the frame or the bottom of the tank, and say so: mounted = \"frame\" of [[recorder]]."});
}

} // namespace

std::string axes_used(const std::vector<DrivenModel>& models) {
  std::string used;
  for (const DrivenModel& model : models)
    for (const std::string* axis : {&model.recorder.x, &model.recorder.y, &model.recorder.across})
      if (*axis != "none" && used.find(axis->back()) == std::string::npos) used += axis->back();
  return used;
}

void find_gaps_before_runs(const AssessmentOptions& options, Assessment& a) {
  for (const RecordEvents& record : a.records)
    for (const MissingEvidence& missing : record.missing)
      a.missing.push_back({missing.item, "'" + record.file + "': " + missing.reason, missing.remedy});
  find_axes(a);
  if (auto missing = uncovered(a.records, options.voyage)) a.missing.push_back(std::move(*missing));
}

void check_bandwidth_and_position(const AssessmentOptions& options, Assessment& a) {
  if (decision_by_criteria(a, a.summary) != Decision::energise) return;
  find_place(a);
  find_bandwidth(options, a);
}

} // namespace steplap::assess
