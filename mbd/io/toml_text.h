// Parses TOML text into a tree of nodes with their locations. Only this module depends on the TOML library.
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
  std::string key; ///< key in the table that contains it, "" for items of an array
  std::variant<bool, long, double, std::string> scalar;
  std::vector<Node> children; ///< items of an array or table, in the order of the file

  const std::string* file = nullptr; ///< owned by the document
  int line = 0, column = 0;          ///< location of the value
  int key_line = 0, key_column = 0;

  [[nodiscard]] const Node* find(const std::string& child_key) const;
  [[nodiscard]] Node* find(const std::string& child_key);
  void erase(const std::string& child_key);
  [[nodiscard]] bool is_table() const { return type == Type::table; }
  /// Returns true for an array of one or more tables, as written [[name]].
  [[nodiscard]] bool is_array_of_tables() const;
  /// Returns the text, "" if the value is not a text.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Location where() const;
  [[nodiscard]] Location where_key() const;
  /// Returns the type for messages: "a table", "an integer", ...
  [[nodiscard]] const char* type_name() const;
};

/// Parses the text. Throws ModelError if it is not TOML. `file` must outlive the node.
[[nodiscard]] Node parse_toml(const std::string& text, const std::string* file);

} // namespace steplap
