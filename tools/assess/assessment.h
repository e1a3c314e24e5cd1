// Computes a transport assessment from shock records and models: simulates every event of the voyage in every model in order of time,
// repeats the voyage with sampled uncertain values, and applies the criteria. This is `steplap assess` without its console.
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
  std::vector<Evidence> accepted;          ///< missing evidence that the user accepts
  std::vector<std::string> second_records; ///< files of a second recorder on the same machine; empty: there was one only
  Shipment shipment;                       ///< papers, for the sheet that is signed
  std::optional<Voyage> voyage;            ///< begin and end of the transport
  double budget = 60.0;                   ///< s of computing time per started day of record that the search for a lower event threshold may
                                          ///< use
  std::string criteria = "acceptance-3g"; ///< file name or preset
  Estimating estimating = Estimating::cheap;
  SamplingOptions sampling;
  std::function<void(const std::string& what, long done, long all)> progress;
  std::function<std::string()> stop; ///< polled during the work; a text other than "" stops it and becomes the reason
};

/// A shock event, with its results in all models. Events are in order of time over all records.
struct VoyageEvent {
  std::size_t record = 0, event = 0; ///< indices
  std::vector<Passage> passages;     ///< one for each model
  std::vector<Probability> slip;     ///< probability of slip for each model; `runs` is 0 without samples
  std::vector<SharedPassage> shared; ///< one for each friction shared by models of two planes
};

/// A criterion with its outcome and the explanation.
struct Reason {
  std::string criterion, text, source;
  Decision outcome = Decision::energise;
  std::vector<std::string> tests;
  double excess = 0.0; ///< demand on the machine over the permitted value; 0: unknown
};

/// All results of an assessment.
struct Assessment {
  Shipment shipment;
  std::optional<Voyage> voyage;
  std::vector<RecordEvents> records;
  std::vector<DrivenModel> models;
  std::vector<SharedFriction> shared; ///< friction elements that models of two planes have in common
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
  std::vector<Reason> reasons; ///< all criteria, most severe outcome first, and of equal outcomes the largest excess
  std::vector<std::string> hangs_on, assumptions;
  std::vector<std::string> tests;       ///< those that would show the damage, then the usual ones
  std::vector<MissingEvidence> missing; ///< of single records and of all records together
  std::vector<Evidence> accepted;
  std::vector<RecorderFindings> recorders; ///< of the first and the second recorder, each on its own; empty if there was one only
  std::optional<VoyageSummary> by_samples; ///< result with nominal values computed by VoyageRunner, if it was run
  int halvings = 0;                        ///< number of halvings of the event threshold until the decision stayed the same

  /// Returns true if the user accepts that this evidence is missing.
  [[nodiscard]] bool is_accepted(Evidence item) const;
};

/// Runs an assessment. Throws RecordError, FileError or ModelError for invalid input, NumericalFailure if stopped.
[[nodiscard]] Assessment assess(const std::vector<std::string>& records, const std::vector<std::string>& models,
                                const AssessmentOptions& options);

/// Applies the criteria and fills decision, reason, reasons and tests.
void decide(Assessment& assessment);
/// Returns the most severe outcome of all criteria for this summary, with the records of the assessment. Probabilities concern all samples
/// together and are not judged here.
[[nodiscard]] Decision decision_of(const Assessment& assessment, const VoyageSummary& summary);
/// As decision_of(), but without regard to missing evidence.
[[nodiscard]] Decision decision_by_criteria(const Assessment& assessment, const VoyageSummary& summary);
/// Fills events and histories from the events of the records.
void list_events(Assessment& assessment);
/// Simulates the assessment's events with sampled values. `suffix` is added to the name of the sample file.
[[nodiscard]] std::vector<VoyageSample> samples_of(const AssessmentOptions& options, const Assessment& assessment,
                                                   const std::string& suffix);

/// Returns the text of assessment.json.
[[nodiscard]] std::string assessment_json(const Assessment& assessment);

} // namespace steplap::assess
