// A model file that has been read, completed and compiled, with the data needed to write result files.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/model/model.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/run/kind_views.h"
#include "mbd/system/system.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// A model ready to run. It is constant, so runs in several threads may share it.
struct LoadedModel {
  std::string path;                                                             ///< path of the model file, as given
  std::string name;                                                             ///< file name without folder and extension
  std::vector<std::string> overrides;                                           ///< "path=value" settings applied to the file
  std::string text;                                                             ///< effective model as self-contained TOML
  std::vector<InputFile> inputs;                                                ///< all files that were read
  Model model;                                                                  ///< model with all defaults filled in
  std::vector<std::string> plots_left_out;                                      ///< requested plots whose channels are not written
  std::shared_ptr<const System> system;                                         ///< system compiled from `model`; shared by all runs of it
  std::shared_ptr<const KindViews> views = std::make_shared<const KindViews>(); ///< functions of the kinds; never null
  State assembled; ///< initial state after projection of the given poses and velocities onto the constraints
};

/// Returns how many rows the trajectory of a run to its end has: one at each multiple of the output step, and one at the end.
[[nodiscard]] double trajectory_rows(const Model& model);

/// Returns how many numbers the trajectory of a run contains, including times.
[[nodiscard]] double trajectory_numbers(const Model& model, const System& system);

// With the catalogue of the programs: transformer/program.h.

/// Reads and compiles a model file. `catalogue` defines the permitted kinds; the model refers to the kinds, not to the catalogue. Throws
/// ModelError with all errors of the model, or if the trajectory would exceed `most_numbers` of [output]; FileError if the path
/// contains control characters, because the folder of the results is named after the file.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides,
                                                            const RunCatalogue& catalogue);
/// Works like load_model(), but reads `text`. `path` is used for messages, for relative paths inside the model and for the names of
/// results; no file is read from it. Throws as load_model() does.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                                 const std::vector<std::string>& overrides, const RunCatalogue& catalogue);
/// Completes, checks and compiles a model built in code. It has no text, so its results cannot be written to files. Throws ModelError.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_given(const Model& given, const std::string& name,
                                                            std::shared_ptr<const KindViews> views);
/// Wraps a model that has already been completed and compiled. `path` is its name in messages.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_completed(Model completed, std::shared_ptr<const System> system,
                                                                const std::string& path, std::shared_ptr<const KindViews> views);
/// Loads several models. Throws one ModelError with the errors of all.
[[nodiscard]] std::vector<std::shared_ptr<const LoadedModel>>
load_models(const std::vector<std::string>& paths, const std::vector<std::string>& overrides, const RunCatalogue& catalogue);

/// Computes the equilibrium of the model from its initial poses. The given initial velocities are ignored in the search and returned with
/// the pose. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_of(const LoadedModel& loaded);
/// Returns the state at which a run begins. Throws NumericalFailure if an equilibrium is requested and none exists.
[[nodiscard]] State initial_state_of(const LoadedModel& loaded);

} // namespace steplap
