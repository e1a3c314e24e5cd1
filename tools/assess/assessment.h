// From records and models to a decision: every event of the voyage through every model, in order of time, then the voyage under all
// that is uncertain, then the criteria. The whole of what `steplap assess` does, without a console.
#pragma once

#include "tools/assess/coverage.h"
#include "tools/assess/passage.h"
#include "tools/assess/samples.h"
#include "transformer/decision/criteria.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace steplap::assess {

/// How an assessment is made.
struct AssessmentOptions {
  EventReading reading;
  std::vector<std::string> overrides;     ///< "path=value", laid over every model
  std::vector<Evidence> accepted;         ///< missing evidence that the user takes upon himself
  std::optional<Voyage> voyage;           ///< from when to when the machine travelled
  double budget = 60.0;                   ///< s of computing, for each day of record begun, that the search for a threshold may take
  std::string criteria = "acceptance-3g"; ///< file or preset
  Estimating estimating = Estimating::cheap;
  SamplingOptions sampling;
  std::function<void(const std::string& what, long done, long all)> progress;
  std::function<std::string()> stop; ///< what it says is why to stop; ""
};

/// An event of the voyage, in order of time over all records.
struct VoyageEvent {
  std::size_t record = 0, event = 0; ///< indices
  std::vector<Passage> passages;     ///< one for each model
  std::vector<Probability> slip;     ///< the same; no runs without samples
  std::vector<SharedPassage> shared; ///< one for each shared friction
};

/// Why the decision is what it is.
struct Reason {
  std::string criterion, text, source;
  Decision outcome = Decision::energise;
  std::vector<std::string> tests;
};

/// All that was found.
struct Assessment {
  std::vector<RecordEvents> records;
  std::vector<DrivenModel> models;
  std::vector<SharedFriction> shared; ///< frictions that models of several planes have in common
  std::vector<VoyageEvent> events;
  std::vector<std::vector<DriveHistory>> histories; ///< per model, of the events
  std::unique_ptr<UncertainValues> uncertain;
  std::vector<VoyageSample> samples;
  std::vector<double> shares; ///< of the uncertain numbers; empty if not known
  VoyageSummary summary;
  Probability damage;
  DecisionCriteria criteria;
  Decision decision = Decision::open;
  std::string reason;
  std::vector<Reason> reasons; ///< the gravest first; all criteria
  std::vector<std::string> hangs_on, assumptions, tests;
  std::vector<MissingEvidence> missing; ///< of the records and of all together
  std::vector<Evidence> accepted;
  std::optional<VoyageSummary> by_samples; ///< the voyage with the models' own values by the way of the samples, once it was made
  int halvings = 0;                        ///< of the threshold, until the outcome stayed the same

  [[nodiscard]] bool is_accepted(Evidence item) const;
};

/// Throws RecordError, FileError and ModelError for what cannot be used, NumericalFailure if it was stopped.
[[nodiscard]] Assessment assess(const std::vector<std::string>& records, const std::vector<std::string>& models,
                                const AssessmentOptions& options);

/// Judges what was found: fills decision, reason, reasons and tests.
void decide(Assessment& assessment);
/// What criteria make of a voyage with values of its own: the worst outcome, records as the assessment has them. Probabilities are of
/// all values together, and are left out.
[[nodiscard]] Decision decision_of(const Assessment& assessment, const VoyageSummary& summary);
/// The same by the criteria alone, whatever evidence is missing.
[[nodiscard]] Decision decision_by_criteria(const Assessment& assessment, const VoyageSummary& summary);
/// Fills events and histories from the events of the records.
void list_events(Assessment& assessment);
/// Voyages of the assessment's events with drawn values. `suffix` tells their store from others.
[[nodiscard]] std::vector<VoyageSample> samples_of(const AssessmentOptions& options, const Assessment& assessment,
                                                   const std::string& suffix);

/// The text of assessment.json.
[[nodiscard]] std::string assessment_json(const Assessment& assessment);

} // namespace steplap::assess
