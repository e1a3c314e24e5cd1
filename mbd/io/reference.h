// What a model file may say: generated from the field tables, so it is never out of date.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Rows of a table, the first of which is its head.
using ReferenceRows = std::vector<std::vector<std::string>>;

/// One row for each kind of element, signal and table.
[[nodiscard]] ReferenceRows kinds_rows(const Catalogue& catalogue);

/// What a model file may say of one kind.
struct KindReference {
  std::string heading, doc;
  ReferenceRows fields;
  ReferenceRows channels; ///< of its elements; empty if they have none
};

/// Of a kind, of "body", "marker", "simulation", "output" or "model" (the top-level
/// keys). Throws ModelError for a name that there is not, with the nearest that there is.
[[nodiscard]] KindReference kind_reference(const Catalogue& catalogue, const std::string& name);
/// The whole reference in Markdown.
[[nodiscard]] std::string reference_markdown(const Catalogue& catalogue);

} // namespace steplap
