// Tables for the screen.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace steplap {

/// Columns as wide as their widest cell (counted in characters, not bytes).
class TextTable {
public:
  enum class Align { left, right };

  /// `indent` blanks before every row, two between columns; `columns` tells how each is aligned.
  explicit TextTable(std::vector<Align> columns, int indent = 2);

  /// Missing cells are empty.
  void add_row(std::vector<std::string> cells);
  [[nodiscard]] bool is_empty() const { return rows_.empty(); }
  friend std::ostream& operator<<(std::ostream& stream, const TextTable& table);

private:
  std::vector<Align> columns_;
  int indent_ = 2;
  std::vector<std::vector<std::string>> rows_;
};

} // namespace steplap
