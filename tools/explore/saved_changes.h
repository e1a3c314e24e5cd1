// Saves changes of a model as a file that extends the model's file.
#pragma once

#include "tools/explore/explored_model.h"

#include <string>

namespace steplap {

/// Returns the text of a TOML file for the folder of the model's file. It `extends` that file and sets every changed key, including the
/// overrides. The result is verified by reading it and comparing the models. Throws ModelError if the values are invalid, or if no such
/// file can express them.
[[nodiscard]] std::string text_of_changes(const ExploredModel& model, const ExploredValues& values);

/// Writes that text to the file `name` in the model's folder and returns its path. Throws ModelError as above, FileError if the name is
/// invalid, the file exists, or the folder is not writable.
std::string save_changes(const ExploredModel& model, const ExploredValues& values, const std::string& name);

} // namespace steplap
