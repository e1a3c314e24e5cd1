// A model file with the files it extends, merged into one tree.
//
// `extends = "other.toml"` takes everything from the other file (relative to the file that says so;
// chains are allowed) and lays this file over it: tables such as [simulation] merge key by key,
// arrays of tables such as [[element]] merge by `name`: an entry of the same name replaces the keys
// that it gives, another is appended, `remove = true` takes the inherited entry out. `unset =
// ["key"]` in an entry or a table drops inherited keys, `replace = true` all of them: what it gives is all there
// is, as another kind of the same name needs. Every value remembers the file it stands in.
#pragma once

#include "mbd/io/toml_text.h"

#include <deque>

namespace steplap {

struct Document {
  struct Source {
    std::string file;
    std::string text;
  };

  Node root;
  std::shared_ptr<std::deque<Source>> sources; ///< the file itself, then those it extends
  std::vector<Diagnostic> problems; ///< found while merging, to be reported with the rest
};

/// Throws ModelError if a file cannot be read or is not TOML, or if `extends` goes round in
/// circles.
[[nodiscard]] Document load_document(const std::string& path);
/// The same for text at hand; `file_name` is what messages call it and what `extends` is relative
/// to.
[[nodiscard]] Document parse_document(std::string text, const std::string& file_name);
/// The text of the file and of all files it extends, each after a line with its name.
[[nodiscard]] std::string model_source_text(const std::string& path);

/// Notes in document.problems every key and every text with a control character: names go into CSV, onto terminals and pages.
/// Only `source`, which says where values come from, may have lines.
void refuse_control_characters(Document& document);

/// What an entry of an array of tables is called, "" without a name.
[[nodiscard]] std::string entry_name(const Node& entry);

} // namespace steplap
