#include "tools/assess/vibration.h"

#include "mbd/base/shown_text.h"
#include "tools/assess/voyage_evidence.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

namespace steplap::assess {

namespace {

constexpr double k_release = 0.25; // largest signal at the tapered ends of an event, as a fraction of its threshold
// lowest threshold, as a fraction of the requested one; smaller signals are noise of a recorder without mechanical effect
constexpr double k_floor = 0.03;
// least mean that is sustained, m/s²: less is a slope of the road, or an offset
constexpr double k_least_sustained = 0.1 * k_gravity;
constexpr double k_same_margin = 0.02; // largest relative change of the margin between equal results
constexpr double k_same_share = 0.1;   // largest change of the probability between equal results, as a fraction of its confidence interval
// events that differ by less in length, s, count as equal: the difference has signals below a quarter of the threshold
constexpr double k_same_length = 0.2;
constexpr double k_day = 86400.0;      // length of a day, s
constexpr double k_most_samples = 4e6; // largest number of samples in all events together: 200 MB
const std::string k_too_long = "it lasts too long to be held in memory";
constexpr int k_needed = 2, k_most_halvings = 12;

double least_threshold(const RecordEvents& record) { return k_floor * record.rules.threshold; }

/// Results that must be the same for two thresholds.
struct Outcome {
  Decision decision = Decision::open;
  double margin = 0.0;
  Probability damage;
  std::vector<VoyageSample> samples;
  VoyageSummary summary;
};

bool is_same(const Outcome& a, const Outcome& b) {
  const bool is_margin_same =
      (std::isinf(a.margin) && std::isinf(b.margin)) || std::abs(a.margin - b.margin) <= k_same_margin * std::abs(a.margin);
  const bool is_share_same =
      a.damage.runs == 0 || std::abs(a.damage.value - b.damage.value) <= k_same_share * (a.damage.high - a.damage.low);
  return a.decision == b.decision && is_margin_same && is_share_same;
}

/// Events of all records for one threshold, with the results of their simulation.
struct Level {
  std::vector<std::vector<RecordedEvent>> events;
  Outcome outcome;
  int halvings = 0;
};

bool are_same(const Level& level, const Assessment& a) {
  for (std::size_t r = 0; r < a.records.size(); ++r) {
    const std::vector<RecordedEvent>&x = level.events[r], &y = a.records[r].events;
    if (x.size() != y.size()) return false;
    for (std::size_t e = 0; e < x.size(); ++e)
      if (std::abs(x[e].event.begin - y[e].event.begin) > k_same_length || std::abs(x[e].event.end - y[e].event.end) > k_same_length)
        return false;
  }
  return true;
}

class Search {
public:
  Search(const AssessmentOptions& options, Assessment& a) : options_(options), a_(a), used_(axes_used(a.models)), begin_(std::clock()) {
    double covered = 0.0;
    for (const RecordEvents& record : a.records) covered += record.recording.facts.last - record.recording.facts.first;
    budget_ = options.budget * std::max(1.0, covered / k_day);
  }

  void run() {
    if (!load(0)) {
      load_greatest();
      return add_missing(0, k_too_long);
    }
    if (a_.events.empty()) return;
    Level reference = level_now(0);
    reference.outcome = outcome(0);
    int same = 0;
    for (int halvings = 1; same < k_needed && halvings <= k_most_halvings && is_lower(halvings); ++halvings) {
      Level before = level_now(halvings - 1);
      const bool fits = load(halvings);
      if (fits && are_same(before, a_)) { // no evidence, unless strength alone decides: weaker signals move nothing either
        if (!reference.outcome.summary.moves) ++same;
        continue;
      }
      if (!fits || length() > affordable_) {
        add_missing(halvings,
                    fits ? "its runs would take longer than the budget of " + rounded_text(budget_, 3) + " s of computing" : k_too_long);
        break;
      }
      Outcome now = outcome(halvings);
      if (is_same(reference.outcome, now)) {
        ++same;
        continue;
      }
      same = 0;
      reference = level_now(halvings);
      reference.outcome = std::move(now);
    }
    for (std::size_t r = 0; r < a_.records.size(); ++r) a_.records[r].events = std::move(reference.events[r]);
    a_.samples = std::move(reference.outcome.samples);
    a_.by_samples = std::move(reference.outcome.summary);
    a_.halvings = reference.halvings;
    list_events(a_);
  }

private:
  bool load(int halvings) {
    double most = k_most_samples;
    for (RecordEvents& record : a_.records) {
      if (options_.stop)
        if (const std::string why = options_.stop(); !why.empty())
          throw RunStopped(why + " while '" + record.file + "' was searched for events.");
      if (record.recording.layout.is_peaks) continue;
      if (!find_events(options_.reading, rules_at(record, used_, halvings), most / record.rate, record)) return false;
      most -= length_of(record) * record.rate;
    }
    list_events(a_);
    return true;
  }

  static double length_of(const RecordEvents& record) {
    double sum = 0.0;
    for (const RecordedEvent& event : record.events) sum += event.event.end - event.event.begin;
    return sum;
  }

  // Loads the events above the requested threshold, or above the record's largest value if this is lower.
  void load_greatest() {
    for (RecordEvents& record : a_.records) {
      EventRules rules = record.rules;
      if (record.recording.layout.is_peaks) continue;
      double greatest = 0.0;
      for (const double value : record.greatest) greatest = std::max(greatest, value);
      rules.threshold = std::min(rules.threshold, 0.999 * greatest);
      static_cast<void>(find_events(options_.reading, rules, std::numeric_limits<double>::infinity(), record));
    }
    list_events(a_);
  }

  Level level_now(int halvings) const {
    Level level;
    for (const RecordEvents& record : a_.records) level.events.push_back(record.events);
    level.halvings = halvings;
    return level;
  }

  // Simulates the voyage with nominal values and with all samples. Updates the duration of events that the remaining computing time
  // permits.
  Outcome outcome(int halvings) {
    const std::clock_t from = std::clock();
    if (options_.progress) options_.progress("threshold", halvings, k_most_halvings);
    Outcome now;
    now.summary = voyage_with(a_.models, a_.histories, *a_.uncertain, a_.uncertain->nominal(), a_.shared).summary;
    now.decision = decision_by_criteria(a_, now.summary);
    now.margin = now.summary.least_margin;
    if (!a_.uncertain->empty() && options_.sampling.samples > 0) {
      now.samples = samples_of(options_, a_, halvings == 0 ? "" : "_" + std::to_string(halvings));
      now.damage = damage_probability(now.samples);
    }
    const double cost = seconds_since(from) / std::max(length(), 1e-9);
    affordable_ = std::max(0.0, (budget_ - seconds_since(begin_)) / std::max(cost, 1e-12));
    return now;
  }

  // Returns the total simulated time of all events in all models, s.
  double length() const {
    double events = 0.0, sum = 0.0;
    for (const RecordEvents& record : a_.records) events += length_of(record);
    for (const DrivenModel& model : a_.models) sum += events + model.recorder.settle * static_cast<double>(a_.events.size());
    return sum;
  }

  static double seconds_since(std::clock_t from) { return static_cast<double>(std::clock() - from) / CLOCKS_PER_SEC; }

  // Returns true if the threshold of any record is lower than one halving before, that is, if the lowest threshold is not reached yet.
  bool is_lower(int halvings) const {
    return std::any_of(a_.records.begin(), a_.records.end(), [&](const RecordEvents& record) {
      return !record.recording.layout.is_peaks && rules_at(record, used_, halvings).each != rules_at(record, used_, halvings - 1).each;
    });
  }

  void add_missing(int halvings, const std::string& why) {
    double lowest = 0.0;
    for (const RecordEvents& record : a_.records)
      if (const auto each = rules_at(record, used_, halvings).each; each && !record.recording.layout.is_peaks)
        for (const double value : *each)
          if (std::isfinite(value)) lowest = lowest == 0.0 ? value : std::min(lowest, value);
    a_.missing.push_back({Evidence::vibration,
                          "Vibration above " + rounded_text(lowest / k_gravity, 2) +
                              " g is not run whole, although the outcome may depend on it: " + why + ".",
                          "Give a larger budget."});
  }

  const AssessmentOptions& options_;
  Assessment& a_;
  std::string used_;
  std::clock_t begin_;
  double budget_ = 0.0, affordable_ = 0.0; ///< computing time permitted, s; duration of events that the rest of it permits, s
};

} // namespace

EventRules rules_at(const RecordEvents& record, const std::string& used, int halvings) {
  EventRules rules = record.rules;
  rules.release = k_release;
  std::array<double, 3> each{};
  each.fill(std::numeric_limits<double>::infinity());
  const std::string axes = record.axes();
  std::size_t largest = 0;
  double most = -1.0;
  bool has_any = false;
  constexpr double k_below = 0.999; // lower than 1, so that the largest sample exceeds the threshold
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const bool is_used = used.find(axes[i]) != std::string::npos;
    const double greatest = record.greatest[i];
    if (is_used && greatest > most) most = greatest, largest = i;
    if (!is_used) each[i] = rules.threshold;
    else if (greatest > least_threshold(record))
      each[i] = std::max(least_threshold(record), std::min(rules.threshold, k_below * greatest) / std::exp2(halvings));
    if (is_used && halvings > 0) rules.sustained[i] = std::max(k_least_sustained, k_release * each[i]);
    has_any |= greatest > each[i];
  }
  if (!has_any && most >= 0.0) { // the axis has only noise: its largest value alone is an event
    each[largest] = k_below * most;
    rules.release = 1.0;
  }
  rules.each = each;
  return rules;
}

void find_events_that_matter(const AssessmentOptions& options, Assessment& assessment) { Search(options, assessment).run(); }

} // namespace steplap::assess
