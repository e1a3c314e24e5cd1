// Overrides values of a merged document: "path=value", given by --set on the command line.
//
// A path is a top-level key ("title"), a key of a table ("simulation.step"), or a key of a named entry ("element.front block.preload");
// names may contain blanks and points. Keys of inline tables and items of lists follow after further points ("element.rope.a.angle",
// "gravity.1"). The value is read as TOML ("1e-4", "[1, 2]", "true") or else as a string ("48 t"). The bare word `unset` removes the key,
// so that its default applies; to set that text, write it in quotes.
#pragma once

#include "mbd/io/document.h"

namespace steplap {

/// Top-level keys permitted in a model file.
struct TopLevelNames {
  std::vector<std::string> keys;   ///< title, gravity, ...
  std::vector<std::string> tables; ///< simulation, output
  std::vector<std::string> arrays; ///< body, element, ...
};

/// Applies one override. Errors, such as a path that does not exist, are added to document.problems. Whether the last key is a field of its
/// entry is checked later, when fields are read.
void apply_override(Document& document, const std::string& assignment, const TopLevelNames& names);

} // namespace steplap
