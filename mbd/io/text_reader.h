// Models that come as text and not as a file, for programs that make them.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// As parse_model(), and `standalone` becomes what standalone_text() gives, of the same reading. Throws ModelError.
[[nodiscard]] Model parse_model_text(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                     const std::vector<std::string>& overrides, std::string& standalone);

} // namespace steplap
