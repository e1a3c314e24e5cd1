// Runs all load cases of a model ([[case]], mbd/io/load_case.h) and combines their limits: which case governs each limit, and which limit
// governs each case.
//
// A case is loaded with its overrides and run by judged_run(), so its numbers are those of a run of the model with the same overrides.
// Criteria that do not apply to a case are removed before it is judged; built-in criteria of elements always apply.
#pragma once

#include "mbd/io/load_case.h"
#include "mbd/run/overview.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A criterion in one case.
struct CaseLimit {
  std::string name;                  ///< name of the criterion of the model; for a built-in one, element and requirement
  CriterionResult result;            ///< value, limit, reserve (margin), error and outcome
  std::optional<double> share;       ///< utilisation; 1 is the limit; empty for events and without a value
  std::optional<double> share_error; ///< error of the utilisation; NaN: unknown
};

/// Result of one case.
struct CaseResult {
  LoadCase load;                      ///< the case as defined in the model
  std::vector<std::string> overrides; ///< all "path=value" with which the model was loaded
  Judgement judgement;                ///< verdict, and reasons against "hold"
  std::string reason;                 ///< reason of the verdict, one sentence
  std::string failure;                ///< why the run did not reach its end; empty if it did
  std::vector<CaseLimit> limits;      ///< one for each criterion of `judgement`, in its order

  /// Returns the governing limit: the worst outcome, then the highest utilisation; nullptr without limits.
  [[nodiscard]] const CaseLimit* governing() const;
};

/// Results of all cases.
struct LoadCaseResults {
  std::vector<std::shared_ptr<const LoadedModel>> models; ///< models without the overrides of cases; one for each plane, at least one
  std::vector<CaseResult> cases;                          ///< results, at least one

  /// Returns the worst verdict of all cases.
  [[nodiscard]] Verdict verdict() const;
  /// Returns the reason of that verdict, one sentence.
  [[nodiscard]] std::string reason() const;
};

/// One limit in all cases.
struct LimitRow {
  std::string name;                      ///< as in CaseLimit
  std::vector<const CaseLimit*> in_case; ///< one for each case; nullptr: the limit does not apply to the case
  std::size_t governing = 0;             ///< index of the governing case
};

/// Adds the errors of a model that was read with the overrides of a case. Their location is that of the case, because the model without
/// these overrides is valid.
void add_case_problems(const LoadCase& one, const ModelError& error, std::vector<Diagnostic>& problems);
/// Adds an error for each pattern of the case that names no criterion of the model, and one if the case has no criteria at all.
void check_case_criteria(const LoadCase& one, const Model& model, std::vector<Diagnostic>& problems);
/// Removes the criteria of a completed model that do not apply to the case.
void keep_case_criteria(const LoadCase& one, Model& model);

/// Samples to be recorded in the run of every case.
struct CaseReading {
  std::vector<std::string> channels; ///< names of channels
  double step = 0.0;                 ///< sampling interval, s
  /// Called with the index and report of each case that started, from any thread; may be empty.
  std::function<void(std::size_t, const Report&)> take = {};
};

/// Runs all cases in parallel. `overrides` apply to every case, before its own. Throws ModelError with the location of the [[case]] if a
/// case sets what does not exist, names no criterion of the model or has none at all, and if the model has no case.
[[nodiscard]] LoadCaseResults run_load_cases(const std::string& path, const std::vector<std::string>& overrides,
                                             const RunCatalogue& catalogue, const RunOptions& options, const CaseReading& reading = {});
/// Returns the matrix of limits by cases. Its pointers lead into `results`.
[[nodiscard]] std::vector<LimitRow> limit_rows(const LoadCaseResults& results);

} // namespace steplap
