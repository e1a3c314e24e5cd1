// One sample: the values of the variables put into the models, run, and looked at.
#pragma once

#include "mbd/simulation/simulation.h"
#include "mbd/trust/judgement.h"
#include "tools/study/expression.h"
#include "tools/study/study_reader.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap::study {

enum class SampleStatus : int {
  ok = 0,
  stopped = 1,     ///< an element ended the run: a joint came apart
  untrusted = 2,   ///< the run reached its end, but is not to be trusted
  gave_up = 3,     ///< the computation could not be finished, or not be begun
  impossible = 4,  ///< the model does not take the values
  not_a_number = 5 ///< a limit state has no value
};
[[nodiscard]] const char* name_of(SampleStatus status);

/// The model with the values of all variables that are set in it, not completed. Throws ModelError.
[[nodiscard]] Model model_with(const LoadedStudy& loaded, const StudyModel& model, const double* values);

struct Outcome {
  SampleStatus status = SampleStatus::ok;
  std::string reason;
  std::vector<double> numbers; ///< responses, then limit states; not-a-number where unknown
  std::vector<double> curve;   ///< at the measured times of all histories, one after the other
  double error = 0.0;          ///< energy residual, of what was turned over; the largest of the models
  double evaluations = 0.0;    ///< of the equations of motion
  double cpu_seconds = 0.0;
};

/// Runs samples; one object for each thread.
class Scene {
public:
  explicit Scene(const LoadedStudy& loaded);

  /// Never throws for what a sample may do.
  void run(const double* values, Outcome& outcome);

  /// Whether all numbers that are formulas of others are what the formulas give, of an outcome that was stored.
  [[nodiscard]] bool is_derived(const std::vector<double>& values, const Outcome& outcome);

  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

private:
  struct Runner;
  void run_model(Runner& runner, const double* values, Outcome& outcome);
  void run_system(const Runner& runner, const Model& whole, System& system, Outcome& outcome);
  void run_judged(const Runner& runner, Model whole, std::unique_ptr<System> system, Outcome& outcome);
  void look(const Runner& runner, const Judgement& judgement, const RunResult& result, Outcome& outcome);
  void compare(const Runner& runner, const RunResult& result, Outcome& outcome) const;

  const LoadedStudy& loaded_;
  std::vector<std::unique_ptr<Runner>> runners_;                ///< one a model
  std::vector<std::pair<std::size_t, Expression>> expressions_; ///< of numbers, in their order
  std::vector<double> values_;                                  ///< variables and numbers
};

} // namespace steplap::study
