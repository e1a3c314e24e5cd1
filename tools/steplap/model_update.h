// Model files brought up to date: `format = 1` at the top, and present names for keys that were renamed. Comments and layout stay.
#pragma once

#include "mbd/model/model.h"

#include <cstddef>
#include <string>

namespace steplap {

/// A model file after an update.
struct ModelUpdate {
  std::string text;             ///< of the file
  bool adds_format = false;     ///< a line `format = 1` is new
  std::size_t renamed_keys = 0; ///< that have their present names now
  std::size_t left_keys = 0;    ///< earlier names that are not in this file's text as given, for example in a file that it extends
};

/// Updates `text`, the content of `file`, for the findings in `model`, which was read from it.
[[nodiscard]] ModelUpdate updated(const std::string& text, const std::string& file, const Model& model);

} // namespace steplap
