// Reads a model file with the files that it extends, merged into one tree.
//
// `extends = "other.toml"` takes everything from the other file (relative to the extending file; chains are allowed) and lays this file
// over it. Tables such as [simulation] merge key by key. Arrays of tables such as [[element]] merge by `name`: an entry with an existing
// name replaces the keys that it gives, another one is appended, and `remove = true` removes the inherited entry. In an entry or table,
// `unset = ["key"]` drops inherited keys and `replace = true` drops all of them, for example to change the kind. Every value knows the file
// from which it comes.
#pragma once

#include "mbd/io/toml_text.h"

#include <deque>

namespace steplap {

/// Version of the model-file format. Each file states the version of its own text, by `format = 1` at its top.
inline constexpr long k_file_format = 1;

struct Document {
  struct Source {
    std::string file;
    std::string text;
  };

  /// A file that is used as a sub-assembly of the model or of another part (parts.h).
  struct Part {
    std::string prefix;      ///< prefix of all names in it: "wagon 2."
    const std::string* file; ///< name of the file
    Location where;          ///< location of its [[part]]
  };
  /// Formula for a coordinate of a part's position. The unit of its result is checked later, when parameters are known.
  struct PartPlace {
    Node node;
    std::string unit, subject;
  };

  Node root;
  std::shared_ptr<std::deque<Source>> sources; ///< the file, then the files that it extends and those of its parts
  std::vector<Diagnostic> problems;            ///< problems found while merging, reported with all others
  std::vector<Part> parts;                     ///< each part comes after the part that contains it
  std::vector<PartPlace> part_places;
  std::vector<std::string> files_without_format; ///< each listed once
  bool is_repeated = false;                      ///< some entries come from `repeat`
};

/// Reads a file. Throws ModelError if a file cannot be read, is not TOML, or extends itself through others.
[[nodiscard]] Document load_document(const std::string& path);
/// Reads a text. `file_name` is used in messages and as the base of relative paths in `extends`.
[[nodiscard]] Document parse_document(std::string text, const std::string& file_name);
/// Reads another file with all files that it extends, and adds these files and their problems to the document. Returns the tree. Throws
/// like load_document(), at `where` if the file cannot be read.
[[nodiscard]] Node load_into(Document& document, const std::string& path, const Location& where);
/// Merges the entry `over` of [[array]] into the inherited entry `base` of the same name. Returns false if `over` says `remove = true`.
[[nodiscard]] bool merge_entry(Node& base, Node over, const std::string& array, std::vector<Diagnostic>& problems);
/// Returns the text of the file and of all files that it extends, each after a line with its name.
[[nodiscard]] std::string model_source_text(const std::string& path);

/// Adds a problem to document.problems for every key and text with a control character, because names appear in CSV files, terminals and
/// pages. Only `source`, which states the origin of values, may contain line breaks.
void refuse_control_characters(Document& document);

/// Returns the name of an entry of an array of tables, "" if it has none.
[[nodiscard]] std::string entry_name(const Node& entry);

} // namespace steplap
