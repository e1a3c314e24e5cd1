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

/// The version of the format of model files, as `format = 1` at the top of a file states it. Each file has its own.
inline constexpr long k_file_format = 1;

struct Document {
  struct Source {
    std::string file;
    std::string text;
  };

  /// A file that is a part of the model, or of a part (parts.h).
  struct Part {
    std::string prefix;      ///< of the names of what is in it: "wagon 2."
    const std::string* file; ///< its file
    Location where;          ///< of its [[part]]
  };
  /// A formula that says where a part stands, whose unit is to be checked.
  struct PartPlace {
    Node node;
    std::string unit, subject;
  };

  Node root;
  std::shared_ptr<std::deque<Source>> sources; ///< the file itself, then those it extends and those of its parts
  std::vector<Diagnostic> problems;            ///< found while merging, to be reported with the rest
  std::vector<Part> parts;                     ///< each after that in which it is
  std::vector<PartPlace> part_places;
  std::vector<std::string> files_without_format; ///< each once
  bool is_repeated = false;                      ///< some of its entries are repetitions
};

/// Throws ModelError if a file cannot be read or is not TOML, or if `extends` goes round in
/// circles.
[[nodiscard]] Document load_document(const std::string& path);
/// The same for text at hand; `file_name` is what messages call it and what `extends` is relative
/// to.
[[nodiscard]] Document parse_document(std::string text, const std::string& file_name);
/// The tree of another file, with all that it extends, for the document to take something from: its sources and problems become the
/// document's. Throws as load_document() does, at `where` if the file cannot be read.
[[nodiscard]] Node load_into(Document& document, const std::string& path, const Location& where);
/// Lays the entry `over` of [[array]] over `base`, as an upper file's entry of the same name would be. False if it says `remove = true`.
[[nodiscard]] bool lay_over(Node& base, Node over, const std::string& array, std::vector<Diagnostic>& problems);
/// The text of the file and of all files it extends, each after a line with its name.
[[nodiscard]] std::string model_source_text(const std::string& path);

/// Notes in document.problems every key and every text with a control character: names go into CSV, onto terminals and pages.
/// Only `source`, which says where values come from, may have lines.
void refuse_control_characters(Document& document);

/// What an entry of an array of tables is called, "" without a name.
[[nodiscard]] std::string entry_name(const Node& entry);

} // namespace steplap
