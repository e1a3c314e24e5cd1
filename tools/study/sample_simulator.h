// Evaluates one sample: sets the variables in the models, runs the models and computes responses and limit states.
#pragma once

#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"
#include "tools/study/expression.h"
#include "tools/study/study_reader.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

/// Outcome of a sample. The numeric values are stored in files and must not change.
enum class SampleStatus : int {
  ok = 0,
  stopped = 1,      ///< an element ended the run: a joint came apart
  untrusted = 2,    ///< the run is complete but cannot be trusted
  gave_up = 3,      ///< the computation failed, or could not start
  impossible = 4,   ///< the model rejects the values
  not_a_number = 5, ///< a limit state has no value
  undecided = 6     ///< a limit state is zero to rounding, so its sign is unknown; the stored number is zero
};
[[nodiscard]] const char* name_of(SampleStatus status);

/// Returns the model with the values of the study's variables, before it is completed. Throws ModelError.
[[nodiscard]] Model model_with(const LoadedStudy& loaded, const StudyModel& model, const double* values);

/// Results of one sample.
struct Outcome {
  SampleStatus status = SampleStatus::ok;
  std::string reason;
  std::vector<double> numbers; ///< responses, then limit states; NaN if unknown
  std::vector<double> curve;   ///< channel values at the measured times of all histories, one history after another
  double error = 0.0;          ///< largest energy residual over the models, relative to the exchanged energy
  double evaluations = 0.0;    ///< number of evaluations of the equations of motion
  double cpu_seconds = 0.0;
};

/// Runs samples. Each thread needs its own object.
class SampleSimulator {
public:
  explicit SampleSimulator(const LoadedStudy& loaded);

  /// Runs a sample. Failures of the sample do not throw; they are part of the outcome.
  void run(const double* values, Outcome& outcome);

  /// Returns true if recomputing the formulas gives the numbers of a stored outcome.
  [[nodiscard]] bool is_derived(const std::vector<double>& values, const Outcome& outcome);

  ~SampleSimulator();
  SampleSimulator(const SampleSimulator&) = delete;
  SampleSimulator& operator=(const SampleSimulator&) = delete;

private:
  struct SharedRunData;
  void run_model(SharedRunData& runner, const double* values, Outcome& outcome);
  void run_system(const SharedRunData& runner, const Model& whole, System& system, Outcome& outcome);
  void run_judged(const SharedRunData& runner, Model whole, std::unique_ptr<System> system, Outcome& outcome);
  void evaluate_responses(const SharedRunData& runner, const Judgement& judgement, const RunResult& result, double reserve,
                          Outcome& outcome);
  void compare(const SharedRunData& runner, const RunResult& result, Outcome& outcome) const;
  void evaluate_formulas(std::vector<double>& all) const;
  [[nodiscard]] std::vector<double> rounding_of_formulas(const std::vector<double>& all) const;
  int derive(const double* values, std::vector<double>& numbers);

  const LoadedStudy& loaded_;
  std::vector<std::unique_ptr<SharedRunData>> runners_;         ///< shared data of each model
  std::vector<std::pair<std::size_t, Expression>> expressions_; ///< formulas, each with the index of the number that it computes
  std::vector<std::size_t> measured_;                           ///< indices of responses that have rounding errors
  std::vector<double> values_;                                  ///< buffer: values of variables, then of numbers
};

} // namespace steplap::study
