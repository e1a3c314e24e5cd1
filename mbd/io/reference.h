// Reference of model files, generated from the field tables.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Rows of a table; the first row contains the headings.
using ReferenceRows = std::vector<std::vector<std::string>>;

/// Returns one row for each kind of element, signal and table.
[[nodiscard]] ReferenceRows kinds_rows(const Catalogue& catalogue);

/// Reference of one kind.
struct KindReference {
  std::string heading, doc;
  ReferenceRows fields;
  ReferenceRows channels; ///< channels of its elements; empty if they have none
  std::string example;    ///< TOML of an element with what it needs; empty for kinds that are no elements
};

/// Returns the references of all kinds with this name; a table and a signal may share one. Other names are "body", "marker", "simulation",
/// "output" and "model" (the top-level keys). Throws ModelError for an unknown name, with the most similar known one.
[[nodiscard]] std::vector<KindReference> kind_references(const Catalogue& catalogue, const std::string& name);
/// Returns a complete model, in TOML, with an element of the kind. Throws ModelError if no kind of element has this name.
[[nodiscard]] std::string example_model(const Catalogue& catalogue, const std::string& name);
/// Returns the whole reference in Markdown.
[[nodiscard]] std::string reference_markdown(const Catalogue& catalogue);

} // namespace steplap
