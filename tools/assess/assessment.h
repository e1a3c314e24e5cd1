// Makes a transport assessment from shock records and models: simulates all events of the voyage in order of time in every model, repeats
// the voyage with sampled uncertain values, and applies the criteria. This is `steplap assess` without its console.
#pragma once

#include "tools/assess/coverage.h"
#include "tools/assess/passage.h"
#include "tools/assess/samples.h"
#include "tools/assess/second_recorder.h"
#include "transformer/decision/criteria.h"
#include "transformer/decision/shipment.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap::assess {

/// Options of an assessment.
struct AssessmentOptions {
  EventReading reading;
  std::vector<std::string> overrides;      ///< "path=value", applied to every model
  std::vector<Evidence> accepted;          ///< kinds of missing evidence that the user accepts
  std::vector<std::string> second_records; ///< files of a second recorder on the same machine; empty: there was one only
  Shipment shipment;                       ///< serial numbers, journey and recorders, printed on the sheet that is signed
  std::optional<Voyage> voyage;            ///< begin and end of the transport
  double budget = 60.0;                    ///< computing time, s per started day of record, for the search of a lower event threshold
  std::string criteria = "acceptance-3g";  ///< file name or preset
  Estimating estimating = Estimating::cheap;
  SamplingOptions sampling;
  std::function<void(const std::string& what, long done, long all)> progress;
  std::function<std::string()> stop; ///< called repeatedly; a non-empty text stops the assessment and becomes its reason
};

/// A shock event with its results in all models. Events of all records are ordered by time.
struct VoyageEvent {
  std::size_t record = 0, event = 0; ///< indices of the record, and of the event in it
  std::vector<Passage> passages;     ///< one for each model
  std::vector<Probability> slip;     ///< index of the record, and of the event in it
  std::vector<SharedPassage> shared; ///< probability of slip in each model; `runs` is 0 if no samples were simulated
};

/// A criterion with its outcome and the explanation.
struct Reason {
  std::string criterion, text, source;
  Decision outcome = Decision::energise;
  std::vector<std::string> tests;
  double excess = 0.0; ///< demand divided by the permitted value; 0 if unknown
};

/// All results of an assessment.
struct Assessment {
  Shipment shipment;
  std::optional<Voyage> voyage;
  std::vector<RecordEvents> records;
  std::vector<DrivenModel> models;
  std::vector<SharedFriction> shared; ///< friction contacts common to the models of two planes
  std::vector<VoyageEvent> events;
  std::vector<std::vector<DriveHistory>> histories; ///< drive histories, indexed by model and event
  std::unique_ptr<UncertainValues> uncertain;
  std::vector<VoyageSample> samples;
  std::vector<double> shares; ///< share of each uncertain number in the scatter of the margin (shares_of()); empty if unknown
  VoyageSummary summary;
  Probability damage, known_damage; ///< the latter without limits that are assumed
  DecisionCriteria criteria;
  Decision decision = Decision::open;
  std::string reason;
  std::vector<Reason> reasons; ///< all criteria; the most severe outcome first, and for equal outcomes the largest excess
  std::vector<std::string> hangs_on, assumptions;
  std::vector<std::string> tests;       ///< tests to be made on the machine: those that would reveal the damage, then the usual ones
  std::vector<MissingEvidence> missing; ///< missing evidence of single records and of all records together
  std::vector<Evidence> accepted;
  std::vector<RecorderFindings> recorders; ///< of the first and the second recorder, each on its own; empty if there was one only
  std::optional<VoyageSummary> by_samples; ///< summary with nominal values from the method used for samples, if it was run
  int halvings = 0;                        ///< number of halvings of the event threshold after which the decision no longer changed

  /// Returns true if the user accepts that this evidence is missing.
  [[nodiscard]] bool is_accepted(Evidence item) const;
};

/// Runs an assessment. Throws RecordError, FileError or ModelError for invalid input, NumericalFailure if stopped.
[[nodiscard]] Assessment assess(const std::vector<std::string>& records, const std::vector<std::string>& models,
                                const AssessmentOptions& options);

/// Applies the criteria and fills decision, reason, reasons and tests.
void decide(Assessment& assessment);
/// Returns the most severe outcome of all criteria for `summary`, including missing evidence of the records. Criteria on probabilities are
/// excluded, because they concern all samples together.
[[nodiscard]] Decision decision_of(const Assessment& assessment, const VoyageSummary& summary);
/// As decision_of(), but ignoring missing evidence.
[[nodiscard]] Decision decision_by_criteria(const Assessment& assessment, const VoyageSummary& summary);
/// Fills `events` and `histories` from the events of the records.
void list_events(Assessment& assessment);
/// Simulates all events with sampled values. `suffix` is appended to the name of the sample file.
[[nodiscard]] std::vector<VoyageSample> samples_of(const AssessmentOptions& options, const Assessment& assessment,
                                                   const std::string& suffix);

/// Returns the text of assessment.json.
[[nodiscard]] std::string assessment_json(const Assessment& assessment);

} // namespace steplap::assess
