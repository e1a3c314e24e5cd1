// What a model file may say, as text: generated from the field tables, so it is never out of date.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// One line for each kind of element, signal and table.
[[nodiscard]] std::string kinds_text(const Catalogue& catalogue);
/// All fields of one kind, of "body", "marker", "simulation", "output" or "model" (the top-level
/// keys). Throws ModelError for a name that there is not, with the nearest that there is.
[[nodiscard]] std::string kind_text(const Catalogue& catalogue, const std::string& name);
/// The whole reference in Markdown.
[[nodiscard]] std::string reference_markdown(const Catalogue& catalogue);

} // namespace steplap
