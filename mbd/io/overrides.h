// Values laid over a merged document: "path=value", on the command line behind --set.
//
// A path is a top-level key ("title"), a key of a table ("simulation.step"), or a key of a named
// entry
// ("element.front block.preload"); names may hold blanks and points. Keys of inline tables and
// items of lists follow after further points ("element.rope.a.angle", "gravity.1"). The value is
// read as TOML ("1e-4", "[1, 2]", "true"), else as a string ("48 t"). The bare word `unset` takes a key out that the
// files give, so that its default holds; the text of that name is written in quotes.
#pragma once

#include "mbd/io/document.h"

namespace steplap {

/// Top-level keys that a model file may have.
struct TopLevelNames {
  std::vector<std::string> keys;   ///< title, gravity, ...
  std::vector<std::string> tables; ///< simulation, output
  std::vector<std::string> arrays; ///< body, element, ...
};

/// Applies "path=value"; a path that leads nowhere is noted in document.problems. Whether the last
/// key is a field is left to the reader.
void apply_override(Document& document, const std::string& assignment, const TopLevelNames& names);

} // namespace steplap
