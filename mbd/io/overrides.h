// Overrides values of a merged document: "path=value", given by --set on the command line.
//
// A path is a top-level key ("title"), a key of a table ("simulation.step"), or a key of a named entry ("element.front block.preload");
// names may contain blanks and points. Keys of inline tables and items of lists follow after further points ("element.rope.a.angle",
// "gravity.1"). The value is read as TOML ("1e-4", "[1, 2]", "true") or else as a string ("48 t"). The bare word `unset` removes the key,
// so that its default applies; to set that text, write it in quotes.
// files give, so that its default holds; the text of that name is written in quotes.
#pragma once

#include "mbd/io/document.h"

namespace steplap {

/// Top-level keys permitted in a model file.
struct TopLevelNames {
  std::vector<std::string> keys;   ///< title, gravity, ...
  std::vector<std::string> tables; ///< simulation, output
  std::vector<std::string> arrays; ///< body, element, ...
};

/// Applies "path=value". A path that does not exist is added to document.problems. The reader checks whether the last key is a field.
void apply_override(Document& document, const std::string& assignment, const TopLevelNames& names);

} // namespace steplap
