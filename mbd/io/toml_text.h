// TOML text as a tree of nodes that remember where they stand. The tree is ours, so that the TOML
// library is known to one file only.
#pragma once

#include "mbd/base/diagnostics.h"

#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace steplap {

struct Node {
  enum class Type { boolean, integer, number, text, date, array, table };

  Type type = Type::table;
  std::string key; ///< in the table that holds it, "" for items of an array
  std::variant<bool, long, double, std::string> scalar;
  std::vector<Node> children; ///< of an array or a table, in the order of the file

  const std::string* file = nullptr; ///< kept alive by the document
  int line = 0, column = 0;          ///< of the value
  int key_line = 0, key_column = 0;

  [[nodiscard]] const Node* find(const std::string& child_key) const;
  [[nodiscard]] Node* find(const std::string& child_key);
  void erase(const std::string& child_key);
  [[nodiscard]] bool is_table() const { return type == Type::table; }
  /// An array of one or more tables, as [[name]] makes.
  [[nodiscard]] bool is_array_of_tables() const;
  /// The text if it is one, else "".
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Location where() const;
  [[nodiscard]] Location where_key() const;
  /// What it is, for messages: "a table", "an integer", ...
  [[nodiscard]] const char* type_name() const;
};

/// Throws ModelError for text that is not TOML. `file` must outlive the node.
[[nodiscard]] Node parse_toml(const std::string& text, const std::string* file);

} // namespace steplap
