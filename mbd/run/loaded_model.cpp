#include "mbd/run/loaded_model.h"

#include "mbd/base/shown_text.h"
#include "mbd/io/presentation.h"
#include "mbd/io/read_input.h"
#include "mbd/io/reader.h"
#include "mbd/model/completion.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/start.h"
#include "mbd/run/asked_channels.h"
#include "mbd/run/failure.h"
#include "mbd/run/tipping.h"
#include "mbd/simulation/trajectory.h"

#include <malloc.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

namespace steplap {

namespace {

constexpr std::size_t k_large_text = 1'000'000; // characters of a model

// Returns "wagon" for "models/wagon.toml". A name that consists of dots keeps its extension, because it would denote another folder.
std::string name_of_model(const std::string& path) {
  if (has_control_character(path))
    throw FileError(path, "the name '" + shown(path) + "' of a model file holds control characters: rename the file");
  if (is_standard_input(path)) return "stdin";
  const std::filesystem::path file(path);
  const std::string stem = file.stem().string();
  return stem.find_first_not_of('.') == std::string::npos ? file.filename().string() : stem;
}

// Throws if the trajectory would be too long, because a step in a wrong unit could fill the disk.
void refuse_endless_output(const Model& model, const System& system) {
  const double numbers = trajectory_numbers(model, system);
  if (!(numbers > model.output.most_numbers)) return;
  char text[160];
  std::snprintf(
      text, sizeof text,
      "the trajectory would have %.3g numbers (%.3g GB while it runs, some %.3g GB of text), more than the %.3g of 'most_numbers'", numbers,
      8e-9 * numbers, 20e-9 * numbers, model.output.most_numbers);
  throw ModelError(model.output.where,
                   std::string(text) + ": choose a larger 'step', fewer 'channels', or raise 'most_numbers' of [output]");
}

} // namespace

double trajectory_rows(const Model& model) {
  constexpr double k_slack = 1e-9; // of an interval, within which a run takes two samples as one
  const double intervals = model.simulation.end / model.output.step, whole = std::floor(intervals + k_slack);
  return whole + (intervals - whole > k_slack ? 2.0 : 1.0);
}

double trajectory_numbers(const Model& model, const System& system) {
  const Trajectory trajectory(system, model.output.channels);
  return trajectory_rows(model) * (1.0 + static_cast<double>(trajectory.channels().size()));
}

namespace {

std::unique_ptr<System> compiled(const Model& model) {
  std::unique_ptr<System> system = compile(model);
  restrict_extremes(model, *system);
  return system;
}

// Assembles the joints. If this is impossible, the error is reported as an error of the model.
void put_together(LoadedModel& loaded) {
  refuse_endless_output(loaded.model, *loaded.system);
  loaded.plots_left_out = check_presentation(loaded.model, *loaded.system);
  loaded.assembled = assemble(loaded.model, *loaded.system);
}

} // namespace

std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides,
                                              const RunCatalogue& catalogue) {
  auto loaded = std::make_shared<LoadedModel>();
  loaded->path = shown_input(path);
  loaded->name = name_of_model(path);
  loaded->overrides = overrides;
  const InputFiles read; // must outlive the signals that are built here
  loaded->views = catalogue.views;
  loaded->model = read_model(path, catalogue, overrides, &loaded->text);
  if (loaded->text.size() > k_large_text) ::malloc_trim(0); // the trees of a file take ten times its size, in pieces that nothing else fits
  loaded->system = compiled(loaded->model);
  loaded->inputs = read.files();
  check_written_channels(loaded->model, *loaded->system);
  put_together(*loaded);
  return loaded;
}

std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                   const std::vector<std::string>& overrides, const RunCatalogue& catalogue) {
  auto loaded = std::make_shared<LoadedModel>();
  loaded->path = path;
  loaded->name = name_of_model(path);
  loaded->overrides = overrides;
  const InputFiles read;
  note_input(path, text, false);
  loaded->views = catalogue.views;
  loaded->model = parse_model_text(text, path, catalogue, overrides, loaded->text);
  loaded->system = compiled(loaded->model);
  loaded->inputs = read.files();
  check_written_channels(loaded->model, *loaded->system);
  put_together(*loaded);
  return loaded;
}

std::shared_ptr<const LoadedModel> load_given(const Model& given, const std::string& name, std::shared_ptr<const KindViews> views) {
  Model whole = completed(given);
  std::shared_ptr<const System> system = compiled(whole);
  return load_completed(std::move(whole), std::move(system), name, std::move(views));
}

std::shared_ptr<const LoadedModel> load_completed(Model completed, std::shared_ptr<const System> system, const std::string& path,
                                                  std::shared_ptr<const KindViews> views) {
  auto loaded = std::make_shared<LoadedModel>();
  loaded->path = path;
  loaded->name = name_of_model(path);
  loaded->model = std::move(completed);
  loaded->system = std::move(system);
  loaded->views = std::move(views);
  put_together(*loaded);
  return loaded;
}

std::vector<std::shared_ptr<const LoadedModel>> load_models(const std::vector<std::string>& paths,
                                                            const std::vector<std::string>& overrides, const RunCatalogue& catalogue) {
  std::vector<std::shared_ptr<const LoadedModel>> models;
  std::vector<Diagnostic> problems;
  for (const std::string& path : paths) {
    try {
      models.push_back(load_model(path, overrides, catalogue));
    } catch (const ModelError& error) {
      problems.insert(problems.end(), error.diagnostics().begin(), error.diagnostics().end());
    }
  }
  if (!problems.empty()) throw ModelError(std::move(problems));
  return models;
}

namespace {

// Calls `work`. If no equilibrium is found, adds the location in the model file to the error, and the names of parts that tip in the given
// pose.
template <class Work> auto placed(const LoadedModel& loaded, const Work& work) {
  try {
    return work();
  } catch (const RunStopped&) { // interrupted search: the pose is not examined
    throw;
  } catch (const NumericalFailure& failure) {
    std::string text = failure_of(failure, loaded.model, *loaded.system, 0.0).text;
    for (const std::string& tips : tipping_over(loaded, loaded.assembled)) text += "; " + tips;
    throw NumericalFailure(text);
  }
}

} // namespace

Equilibrium equilibrium_of(const LoadedModel& loaded) {
  return placed(loaded, [&] { return equilibrium_at_start(*loaded.system, loaded.assembled); });
}

State initial_state_of(const LoadedModel& loaded) {
  return placed(loaded, [&] { return start_of(loaded.model, *loaded.system, loaded.assembled); });
}

} // namespace steplap
