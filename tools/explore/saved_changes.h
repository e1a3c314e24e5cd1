// Saves changes of a model as a file that extends the model's file.
#pragma once

#include "tools/explore/explored_model.h"

#include <string>

namespace steplap {

/// Returns the text of a TOML file for the model's folder, which `extends` the model's file and sets the changed values, including the
/// overrides. The text is verified by reading it and comparing the models. Throws ModelError if a value is invalid, or if such a file
/// cannot express the changes.
[[nodiscard]] std::string text_of_changes(const ExploredModel& model, const ExploredValues& values);

/// Writes text_of_changes() to the file `name` in the model's folder and returns its path. Throws ModelError as text_of_changes(), and
/// FileError if the name is invalid, the file exists, or the folder is not writable.
std::string save_changes(const ExploredModel& model, const ExploredValues& values, const std::string& name);

} // namespace steplap
