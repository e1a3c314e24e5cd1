// Updates model files: adds `format = 1` at the top and replaces renamed keys by their present names. Comments and layout are kept.
#pragma once

#include "mbd/model/model.h"

#include <cstddef>
#include <string>

namespace steplap {

/// A model file after an update.
struct ModelUpdate {
  std::string text;             ///< new content of the file
  bool adds_format = false;     ///< true if a line `format = 1` was added
  std::size_t renamed_keys = 0; ///< number of keys that were renamed
  std::size_t missing_keys = 0; ///< old names that were not found in this file's text, for example because an extended file contains them
};

/// Updates `text`, the content of `file`, according to the findings in `model`, which was read from it.
[[nodiscard]] ModelUpdate updated(const std::string& text, const std::string& file, const Model& model);

} // namespace steplap
