// A model that a program has as text.
#pragma once

#include "run/loaded_model.h"

namespace steplap {

/// As load_model(), of text at hand. `path` is what messages call it, what paths in it are relative to, and what its results are named
/// after; nothing is read from there. Throws as load_model() does.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                                 const std::vector<std::string>& overrides = {});

} // namespace steplap
