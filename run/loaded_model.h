// A model read, compiled and put together, with what the files of its results need to know about it.
#pragma once

#include "mbd/io/input_files.h"
#include "mbd/model/model.h"
#include "mbd/rest/equilibrium.h"
#include "mbd/system/system.h"
#include "run/catalogue.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// A model that can be run: read, completed, compiled and put together. Constant, so that runs in several threads may share it.
struct LoadedModel {
  std::string path;                        ///< as given
  std::string name;                        ///< of the file, without folder and ending
  std::vector<std::string> overrides;      ///< "path=value", laid over the file
  std::string text;                        ///< the effective model as TOML that stands alone
  std::vector<InputFile> inputs;           ///< all that it was read from
  Model model;                             ///< completed
  std::vector<std::string> plots_left_out; ///< of channels that are not written
  std::shared_ptr<const System> system;    ///< compiled from `model`; shared with every run of it
  State assembled;                         ///< given poses and velocities moved onto the joints
};

/// How many numbers the trajectory of a run will hold, times included.
[[nodiscard]] double trajectory_numbers(const Model& model, const System& system);

/// Throws ModelError with all that is wrong with the model, and for a trajectory beyond `most_numbers` of [output]; FileError
/// for a name that no folder can have. `catalogue`: the kinds that the file may use; the model refers to the kinds and not to the
/// catalogue.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model(const std::string& path, const std::vector<std::string>& overrides = {},
                                                            const Catalogue& catalogue = program_catalogue());
/// A model made in code, as given: completed, checked and compiled as if it had been read. It has no text, so a run of it cannot
/// be written to files. Throws ModelError.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_given(const Model& given, const std::string& name);
/// One that has been completed and compiled already; `path` is what messages call it.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_completed(Model completed, std::shared_ptr<const System> system,
                                                                const std::string& path);
/// All of them, or a ModelError with what is wrong with any of them.
[[nodiscard]] std::vector<std::shared_ptr<const LoadedModel>> load_models(const std::vector<std::string>& paths,
                                                                          const std::vector<std::string>& overrides = {});

/// Where the model rests, found from its poses without its initial velocities, which are given back
/// with the pose. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_of(const LoadedModel& loaded);
/// The state a run of the model begins at. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] State initial_state_of(const LoadedModel& loaded);

} // namespace steplap
