#include "tools/assess/assessment.h"

#include "mbd/base/shown_text.h"
#include "mbd/base/stop.h"
#include "mbd/run/failure.h"
#include "tools/assess/hangs_on.h"
#include "tools/assess/record_evidence.h"
#include "tools/assess/vibration.h"
#include "tools/assess/voyage_evidence.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace steplap::assess {

namespace {

constexpr double k_same_margin = 0.02; // largest relative difference between the margins of the two computations of a voyage
constexpr double k_still = 1e-3;       // m/s; a body that is slower at the end of an event counts as at rest

void throw_if_stopped(const AssessmentOptions& options, const std::string& where) {
  if (!options.stop) return;
  if (const std::string why = options.stop(); !why.empty()) throw RunStopped(why + " " + where + ".");
}

VoyageSummary summary_of(const Passage& passage, std::size_t number, const std::string& model) {
  VoyageSummary s;
  const std::string where = "event " + std::to_string(number) + " of '" + model + "': ";
  if (!passage.is_made) s.unknown = where + passage.reason;
  else if (!passage.is_trusted) s.unknown = where + passage.trust;
  else if (!passage.still_grows.empty()) s.unknown = where + passage.still_grows;
  for (const JointPassage& joint : passage.joints) {
    if (std::isnan(joint.margin)) s.unknown = where + "the margin of '" + joint.name + "' is not known.";
    s.least_margin = std::min(s.least_margin, joint.margin);
    s.slid = std::max(s.slid, joint.slid_total);
    s.overlap_left = std::min(s.overlap_left, joint.overlap_left);
    s.comes_apart |= joint.came_apart;
    s.slips |= joint.slips;
    if (joint.slips && s.first_slip.empty()) s.first_slip = "'" + joint.name + "' slips in event " + std::to_string(number);
  }
  for (const auto* limits : {&passage.reactions, &passage.clearances, &passage.others})
    for (const LimitPassage& limit : *limits) {
      const bool has_share = std::isfinite(limit.share);
      s.note_limit(limit.outcome, limit.is_assumed, has_share ? limit.share : 0.0,
                   "'" + limit.name + "' in event " + std::to_string(number) +
                       (has_share ? ", " + rounded_text(100.0 * limit.share, 3) + " % of its limit" : ""));
    }
  if (passage.is_made && passage.verdict == Verdict::open)
    s.note_limit(Verdict::open, false, 0.0, "event " + std::to_string(number) + ": " + passage.reason);
  s.lifts = !passage.feet.empty();
  return s;
}

void read_inputs(const std::vector<std::string>& records, const std::vector<std::string>& models, const AssessmentOptions& options,
                 Assessment& a) {
  a.criteria = read_criteria(options.criteria);
  a.accepted = options.accepted;
  a.shipment = options.shipment;
  a.voyage = options.voyage;
  std::vector<Diagnostic> problems;
  for (const std::string& model : models) {
    try {
      a.models.push_back(read_driven_model(model, options.overrides));
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
  a.uncertain = std::make_unique<UncertainValues>(a.models);
  a.shared = find_shared_frictions(a.models);
  if (const std::string apart = unshared_planes(a.models, a.shared); !apart.empty())
    a.missing.push_back({Evidence::planes,
                         "Friction " + apart + " carries loads in different planes, and each is judged as if the other did not exist.",
                         "If it is one friction, give both one name, which a coulomb_stick may have as its 'shared_friction'."});
  for (const std::string& record : records) {
    throw_if_stopped(options, "before '" + record + "' was read");
    a.records.push_back(read_without_events(record, options.reading));
  }
  if (options.reading.pulse && std::none_of(a.records.begin(), a.records.end(), [](const RecordEvents& r) { return r.pulse.has_value(); }))
    throw FileError(a.records.front().file,
                    "a pulse is assumed of lists of peaks alone, and '" + a.records.front().file + "' has waveforms: assume none");
  std::string order;
  bool is_order_known = true;
  order_records(a.records, order, is_order_known);
  if (!order.empty()) a.assumptions.push_back(order);
  if (!is_order_known) a.missing.push_back({Evidence::clock, order, "Give all times with a zone, or all without."});
  for (const RecordEvents& record : a.records)
    for (const DrivenModel& model : a.models)
      if (const std::string unseen = check_gravity(record, model); !unseen.empty()) a.assumptions.push_back(unseen);
}

// Evaluates the shared frictions in event `e`, after it was simulated in all models. Deletes the friction histories, which would be too
// large for a whole voyage.
void pass_planes(SharedFrictions& shared, std::size_t e, Assessment& a) {
  std::vector<const std::vector<SampledFriction>*> traces;
  std::vector<const DriveHistory*> histories;
  for (std::size_t m = 0; m < a.models.size(); ++m) {
    traces.push_back(&a.events[e].passages[m].traces);
    histories.push_back(&a.histories[m][e]);
  }
  a.events[e].shared = shared.pass(traces, histories);
  for (const SharedPassage& passage : a.events[e].shared) add_to(a.summary, a.shared[passage.friction], passage, e + 1);
  for (Passage& passage : a.events[e].passages) passage.traces.clear();
}

void pass_events(const AssessmentOptions& options, Assessment& a) {
  std::vector<VoyageModel> travellers;
  for (const DrivenModel& model : a.models) travellers.emplace_back(model);
  SharedFrictions shared(a.shared);
  long done = 0;
  for (std::size_t e = 0; e < a.events.size(); ++e) {
    for (std::size_t m = 0; m < a.models.size(); ++m) {
      throw_if_stopped(options, "in event " + std::to_string(e + 1));
      if (options.progress) options.progress("events", done++, static_cast<long>(a.events.size() * a.models.size()));
      Passage passage = travellers[m].pass(a.histories[m][e], options.estimating);
      passage.event = e, passage.model = m;
      if (passage.final_speed > k_still && !a.histories[m][e].goes_on)
        passage.findings.push_back("The machine still moves at " + rounded_text(passage.final_speed, 2) +
                                   " m/s when the event is over: raise 'settle' of [[recorder]] if the next event begins from rest.");
      worsen(a.summary, summary_of(passage, e + 1, a.models[m].name));
      a.events[e].passages.push_back(std::move(passage));
    }
    if (!a.shared.empty()) pass_planes(shared, e, a);
  }
}

// Repeats the voyage by the method used for samples. If the results differ, the assessment cannot be trusted.
void check_against_samples(Assessment& a) {
  const VoyageSummary twin =
      a.by_samples ? *a.by_samples : voyage_with(a.models, a.histories, *a.uncertain, a.uncertain->nominal(), a.shared).summary;
  if (!a.summary.unknown.empty()) return;
  const VoyageSummary& own = a.summary;
  const bool is_margin_same = (std::isinf(own.least_margin) && std::isinf(twin.least_margin)) ||
                              std::abs(twin.least_margin - own.least_margin) <= k_same_margin * std::abs(own.least_margin);
  const bool is_use_same = std::abs(twin.planes_use - own.planes_use) <= k_same_margin * own.planes_use;
  const bool is_same =
      twin.unknown.empty() && own.slips == twin.slips && own.comes_apart == twin.comes_apart && is_margin_same && is_use_same;
  if (!is_same)
    a.summary.unknown = "two ways of computing the voyage differ: a least margin of " + rounded_text(own.least_margin, 4) + " and " +
                        rounded_text(twin.least_margin, 4) + (twin.unknown.empty() ? "" : " (" + twin.unknown + ")") +
                        ". Tighten the tolerance of the models.";
}

void sample(const AssessmentOptions& options, Assessment& a) {
  if (a.events.empty()) return;
  check_against_samples(a);
  if (a.uncertain->empty() || options.sampling.samples <= 0) return;
  if (a.samples.empty()) a.samples = samples_of(options, a, "");
  a.damage = damage_probability(a.samples);
  a.known_damage = damage_probability(a.samples, LimitsJudged::known);
  a.shares = shares_of(a.samples);
  for (std::size_t e = 0; e < a.events.size(); ++e)
    for (std::size_t m = 0; m < a.models.size(); ++m) a.events[e].slip.push_back(slip_probability(a.samples, m, e, a.events.size()));
}

void assume(Assessment& a) {
  for (const DrivenModel& model : a.models) {
    const std::string name = "'" + model.name + "': ";
    a.assumptions.push_back(name + "the body '" + model.body + "' moves as the recorder on it read" +
                            (model.recorder.rotation == "held" ? ", without turning." : ", turning freely about the recorder.") +
                            " It is rigid from there to where the rest stands on it.");
    for (const std::string& note : model.notes) a.assumptions.push_back(name + note);
    if (model.recorder.drift == "line")
      a.assumptions.push_back(name + "of each event a constant is taken away, so that velocity ends where it began.");
  }
  a.assumptions.push_back(
      "The voyage begins at rest, and each event where the one before left the machine. Events begin beyond " +
      rounded_text(a.records.empty() ? 0.0 : a.records.front().rules.threshold / std::exp2(a.halvings) / k_gravity, 3) +
      " g on an axis that drives a model, or beyond the same share of the most that it reads; what stays below is not run.");
  for (std::string& sentence : assumptions_of(a.shared)) a.assumptions.push_back(std::move(sentence));
  for (const RecordEvents& record : a.records) a.assumptions.insert(a.assumptions.end(), record.assumed.begin(), record.assumed.end());
  for (const UncertainValue& value : a.uncertain->values())
    if (value.source == "assumed") a.assumptions.push_back("The " + value.name + " is assumed: " + value.source_text + ".");
  for (const DrivenModel& model : a.models)
    for (const std::string& limit : model.assumed_limits)
      a.assumptions.push_back("'" + model.name + "': the limit '" + limit + "' is assumed.");
  constexpr double k_unlikely = 0.01; // probability in each tail; nominal values beyond this quantile are reported
  for (std::size_t i = 0; i < a.uncertain->values().size(); ++i) {
    const UncertainValue& value = a.uncertain->values()[i];
    if (value.nominal >= a.uncertain->quantile(i, k_unlikely) && value.nominal <= a.uncertain->quantile(i, 1.0 - k_unlikely)) continue;
    a.assumptions.push_back("The models' own " + value.name + ", " + rounded_text(value.nominal, 4) +
                            ", lies outside the middle 98 % of its distribution (" + a.uncertain->law_text(i) +
                            "): events in detail and probabilities are of different machines. Give both the same value.");
  }
  if (a.uncertain->values().size() > 1) a.assumptions.push_back("Uncertain values are taken to be independent of each other.");
  for (const MissingEvidence& missing : a.missing)
    if (a.is_accepted(missing.item))
      a.assumptions.push_back("Accepted by the user (" + std::string(name_of(missing.item)) + "): " + missing.reason);
  for (const RecordEvents& record : a.records) {
    const ReadFacts& facts = record.recording.facts;
    if (facts.repeated.count > 0)
      a.assumptions.push_back("Of '" + record.file + "' " + counted(facts.repeated.count, "row", "rows") +
                              " with the time of another are left out, as asked.");
    if (facts.unended_line > 0)
      a.assumptions.push_back("The last line of '" + record.file +
                              "' does not end with a line break: that the file is whole could not be seen.");
  }
}

} // namespace

bool Assessment::is_accepted(Evidence item) const { return std::find(accepted.begin(), accepted.end(), item) != accepted.end(); }

void list_events(Assessment& a) {
  a.events.clear();
  a.histories.clear();
  for (std::size_t r = 0; r < a.records.size(); ++r)
    for (std::size_t e = 0; e < a.records[r].events.size(); ++e) a.events.push_back({r, e, {}, {}, {}});
  for (const DrivenModel& model : a.models) {
    std::vector<DriveHistory>& histories = a.histories.emplace_back();
    for (const VoyageEvent& event : a.events)
      histories.push_back(
          drive_history(a.records[event.record], a.records[event.record].events[event.event], model.recorder, model.marker_angle));
  }
}

std::vector<VoyageSample> samples_of(const AssessmentOptions& options, const Assessment& a, const std::string& suffix) {
  SamplingOptions sampling = options.sampling;
  sampling.stop = options.stop;
  if (!sampling.store.empty() && !suffix.empty()) {
    const std::filesystem::path store(sampling.store);
    sampling.store = (store.parent_path() / (store.stem().string() + suffix + store.extension().string())).string();
  }
  if (options.progress) sampling.progress = [&](long done, long all) { options.progress("samples", done, all); };
  return sample_voyages(a.models, a.histories, *a.uncertain, sampling, a.shared);
}

Assessment assess(const std::vector<std::string>& records, const std::vector<std::string>& models, const AssessmentOptions& options) {
  const StopScope stopping(options.stop);
  Assessment a;
  read_inputs(records, models, options, a);
  find_gaps_before_runs(options, a);
  list_events(a);
  find_events_that_matter(options, a);
  find_rounded_tops(a.records, a.missing);
  pass_events(options, a);
  sample(options, a);
  check_bandwidth_and_position(options, a);
  decide(a);
  if (!options.second_records.empty()) {
    a.recorders = {findings_of(a), assess_second(options.second_records, models, options)};
    decide(a);
  }
  find_dependence(options, a);
  assume(a);
  return a;
}

} // namespace steplap::assess
