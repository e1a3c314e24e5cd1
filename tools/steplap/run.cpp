#include "tools/steplap/run.h"

#include "elements/prescribed_motion.h"
#include "mbd/analysis/assembly.h"
#include "mbd/analysis/start.h"
#include "mbd/io/reader.h"
#include "mbd/io/presentation.h"
#include "tools/steplap/catalogue.h"
#include "tools/steplap/interruption.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace steplap {

namespace {

// A step given in the wrong unit would fill memory and disk.
void refuse_endless_output(const Model& model, const System& system) {
  const double numbers = trajectory_numbers(model, system);
  if (!(numbers > model.output.most_numbers)) return;
  char text[160];
  std::snprintf(text, sizeof text, "the trajectory would have %.3g numbers (%.3g GB of memory, some %.3g GB of text), more than the %.3g of 'most_numbers'",
                numbers, 8e-9 * numbers, 20e-9 * numbers, model.output.most_numbers);
  throw ModelError(model.output.where, std::string(text) + ": choose a larger 'step', fewer 'channels', or raise 'most_numbers' of [output]");
}

} // namespace

double trajectory_numbers(const Model& model, const System& system) {
  const Trajectory trajectory(system, model.output.channels);
  return (std::floor(model.simulation.end / model.output.step) + 1.0) * (1.0 + static_cast<double>(trajectory.channels().size()));
}

std::shared_ptr<const LoadedModel> load_model(const std::string& path,
                                              const std::vector<std::string>& overrides) {
  auto loaded = std::make_shared<LoadedModel>();
  loaded->path = path;
  loaded->name = std::filesystem::path(path).stem().string();
  loaded->overrides = overrides;
  loaded->model = read_model(path, program_catalogue(), overrides);
  loaded->text = effective_model_text(path, program_catalogue(), overrides);
  loaded->system = compile(loaded->model);
  refuse_endless_output(loaded->model, *loaded->system);
  refuse_initial_jumps(loaded->model, *loaded->system);
  loaded->plots_left_out = check_presentation(loaded->model, *loaded->system);
  loaded->assembled = assemble(loaded->model, *loaded->system); // joints that cannot be met are the model's error
  return loaded;
}

std::vector<std::shared_ptr<const LoadedModel>>
load_models(const std::vector<std::string>& paths, const std::vector<std::string>& overrides) {
  std::vector<std::shared_ptr<const LoadedModel>> models;
  std::vector<Diagnostic> problems;
  for (const std::string& path : paths) {
    try {
      models.push_back(load_model(path, overrides));
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
  return models;
}

Equilibrium equilibrium_of(const LoadedModel& loaded) {
  return equilibrium_at_start(*loaded.system, loaded.assembled);
}

State initial_state_of(const LoadedModel& loaded) {
  return start_of(loaded.model, *loaded.system, loaded.assembled);
}

Run run_model(std::shared_ptr<const LoadedModel> loaded, std::function<void(double t)> progress) {
  SimulationOptions options = options_of(loaded->model);
  bool is_over = false; // the last state is sampled after a failure, too
  options.progress = [&is_over, progress = std::move(progress)](double t) {
    if (progress) progress(t);
    if (!is_over) stop_if_interrupted(t);
  };
  Simulation simulation(*loaded->system, initial_state_of(*loaded), std::move(options));
  Run run;
  run.loaded = std::move(loaded);
  try {
    simulation.run();
  } catch (const NumericalFailure& failure) {
    run.failure = failure.what();
    is_over = true;
  }
  run.result = std::move(simulation).result();
  return run;
}

} // namespace steplap
