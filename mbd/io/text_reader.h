// Reads models from text, for programs that generate them.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Reads a text like parse_model() and returns the completed model. `standalone` receives standalone_text() of the document. Throws
/// ModelError.
[[nodiscard]] Model parse_model_text(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                     const std::vector<std::string>& overrides, std::string& standalone);

} // namespace steplap
