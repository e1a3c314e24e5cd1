#include "mbd/run/with_settings.h"

#include "mbd/base/number_text.h"
#include "mbd/io/standalone_text.h"
#include "mbd/model/validate.h"
#include "mbd/run/asked_channels.h"

#include <algorithm>
#include <utility>

namespace steplap {

namespace {

// New contents of [simulation] and [output], with messages for the user.
struct Settings {
  SimulationSettings simulation;
  OutputSettings output;
  std::vector<std::string> assignments; // "path=value"; empty if nothing differs from the model
};

Settings settings_of(const LoadedModel& loaded, const RunOptions& options) {
  Settings s{loaded.model.simulation, loaded.model.output, {}};
  // Assigns a setting, unless the model already has this value.
  const auto lay = [&](const std::string& path, const auto& value, const std::string& text, auto& field) {
    const std::string assignment = path + "=" + text;
    if (field == value && std::find(loaded.overrides.begin(), loaded.overrides.end(), assignment) != loaded.overrides.end()) return;
    field = value;
    s.assignments.push_back(assignment);
  };
  if (options.method) lay("simulation.integrator", *options.method, *options.method, s.simulation.integrator);
  if (options.tolerance) lay("simulation.tolerance", *options.tolerance, number_text(*options.tolerance), s.simulation.tolerance);
  if (options.step) lay("simulation.step", *options.step, number_text(*options.step), s.simulation.step);
  if (options.end) lay("simulation.end", *options.end, number_text(*options.end), s.simulation.end);
  if (options.output_step) lay("output.step", *options.output_step, number_text(*options.output_step), s.output.step);
  return s;
}

// The model itself is valid, so every error is due to the settings.
void check(Model model, const RunOptions& options) {
  model.simulation.where = model.output.where = {"RunOptions", 0, 0};
  std::vector<Diagnostic> problems = validate(model);
  const std::string& method = model.simulation.integrator;
  if (method.empty()) problems.push_back({model.simulation.where, "'method' is empty: leave it out, or name one, such as \"auto\""});
  else if (options.step && problems.empty() && !has_fixed_step(method))
    problems.push_back({model.simulation.where, "'step' is for methods of a fixed step; '" + method +
                                                    "' chooses its steps by 'tolerance': set 'method', too, to \"rk4\" for one"});
  if (!problems.empty()) throw ModelError(std::move(problems));
}

void refuse_changed(const std::vector<InputFile>& now, const std::vector<InputFile>& before) {
  for (const InputFile& file : now)
    if (std::find(before.begin(), before.end(), file) == before.end())
      throw ModelError({file.path, 0, 0}, "the record has changed since the model was loaded: load the model again");
}

} // namespace

std::shared_ptr<const LoadedModel> with_settings(std::shared_ptr<const LoadedModel> loaded, const RunOptions& options) {
  Settings settings = settings_of(*loaded, options);
  if (settings.assignments.empty()) return loaded;
  Model model = loaded->model;
  model.simulation = std::move(settings.simulation);
  model.output = std::move(settings.output);
  check(model, options);
  const InputFiles read; // must outlive the signals that are built here
  std::unique_ptr<System> system = compile(model);
  restrict_extremes(model, *system);
  if (!loaded->inputs.empty()) refuse_changed(read.files(), loaded->inputs);
  auto laid = std::make_shared<LoadedModel>(*load_completed(std::move(model), std::move(system), loaded->path, loaded->views));
  laid->overrides = loaded->overrides;
  laid->overrides.insert(laid->overrides.end(), settings.assignments.begin(), settings.assignments.end());
  if (!loaded->text.empty()) laid->text = text_with_settings(loaded->text, settings.assignments);
  laid->inputs = loaded->inputs;
  return laid;
}

} // namespace steplap
