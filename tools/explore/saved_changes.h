// Changes of a model as a file of their own, which extends the model's.
#pragma once

#include "tools/explore/explored_model.h"

#include <string>

namespace steplap {

/// The text of a TOML file that stands in the folder of the model's file and makes the model with its overrides and these values: it
/// `extends` that file and gives every key that is changed. Throws ModelError for values that make no model, and for those that no
/// such file can give: what it makes has been compared, as a whole.
[[nodiscard]] std::string text_of_changes(const ExploredModel& model, const ExploredValues& values);

/// Writes that text. `name`: of the file, without a folder. Returns its path. Throws ModelError as above, FileError for a name that
/// is none, for a file that is there already, and where the folder cannot be written.
std::string save_changes(const ExploredModel& model, const ExploredValues& values, const std::string& name);

} // namespace steplap
