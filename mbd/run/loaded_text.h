// Loads a model from a text in memory.
#pragma once

#include "mbd/run/loaded_model.h"

namespace steplap {

/// Works like load_model(), but reads `text`. `path` is used for messages, for relative paths inside the model and for the names of
/// results; no file is read from it. Throws as load_model() does.
[[nodiscard]] std::shared_ptr<const LoadedModel> load_model_text(const std::string& text, const std::string& path,
                                                                 const std::vector<std::string>& overrides, const RunCatalogue& catalogue);

} // namespace steplap
