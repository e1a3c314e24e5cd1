// A model from its file to the end of its run.
#pragma once

#include "mbd/analysis/equilibrium.h"
#include "mbd/io/input_files.h"
#include "mbd/simulation/simulation.h"

#include <memory>
#include <string>
#include <vector>

namespace steplap {

/// A model read and compiled, with what the files of its results need to know about it.
struct LoadedModel {
  std::string path;                   ///< as given
  std::string name;                   ///< of the file, without folder and ending
  std::vector<std::string> overrides; ///< "path=value", laid over the file
  std::string text;                   ///< the effective model as TOML that stands alone
  std::vector<InputFile> inputs;      ///< all that it was read from
  Model model;
  std::vector<std::string> plots_left_out; ///< of channels that are not written
  std::unique_ptr<System> system;
  State assembled; ///< given poses and velocities moved onto the joints
};

/// How many numbers the trajectory of a run will hold, times included.
[[nodiscard]] double trajectory_numbers(const Model& model, const System& system);

/// Throws ModelError with all that is wrong with the model, and for a trajectory beyond `most_numbers` of [output].
[[nodiscard]] std::shared_ptr<const LoadedModel>
load_model(const std::string& path, const std::vector<std::string>& overrides = {});
/// All of them, or a ModelError with what is wrong with any of them.
[[nodiscard]] std::vector<std::shared_ptr<const LoadedModel>>
load_models(const std::vector<std::string>& paths, const std::vector<std::string>& overrides = {});

/// What a failure says, with file and line of the elements it happened at.
[[nodiscard]] std::string text_with_places(const NumericalFailure& failure, const Model& model, const System& system);

/// Where the model rests, found from its poses without its initial velocities, which are given back
/// with the pose. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] Equilibrium equilibrium_of(const LoadedModel& loaded);
/// The state a run of the model begins at. Throws NumericalFailure if there is no equilibrium.
[[nodiscard]] State initial_state_of(const LoadedModel& loaded);

struct Run {
  std::shared_ptr<const LoadedModel> loaded;
  RunResult result;    ///< up to the failure, if there was one
  std::string failure; ///< what stopped the run; empty: it reached its end
};

/// Runs to the end, or to a NumericalFailure, which is kept. Throws it only if nothing could be run. `threads`:
/// SimulationOptions::threads.
[[nodiscard]] Run run_model(std::shared_ptr<const LoadedModel> loaded,
                            std::function<void(double t)> progress = {}, int threads = 1);

} // namespace steplap
