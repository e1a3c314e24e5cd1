// Tables of a command, shown as aligned text or as JSON (json_screen.h).
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A cell of a table: the text that is printed, and the exact number for JSON.
struct Cell {
  std::string text;
  std::optional<double> value = {}; ///< SI; NaN if missing in a column of numbers
  std::string unit = {};
  std::optional<double> error = {}; ///< error of the value, if estimated

  Cell(std::string text_) : text(std::move(text_)) {}
  Cell(const char* text_) : text(text_) {}
  Cell(std::string text_, double value_, std::string unit_ = "", std::optional<double> error_ = {})
      : text(std::move(text_)), value(value_), unit(std::move(unit_)), error(error_) {}
};

/// Returns a cell with quantity_text() and the number.
[[nodiscard]] Cell quantity_cell(double value, const std::string& unit);
/// As above, but values that are rounding relative to `scale` are shown as zero.
[[nodiscard]] Cell quantity_cell(double value, const std::string& unit, double scale);
[[nodiscard]] Cell count_cell(std::size_t count);

/// A table. Columns are as wide as their widest cell (counted in characters, not bytes).
class TextTable {
public:
  enum class Align { left, right };
  using Row = std::vector<Cell>;

  /// Creates a table with one column per entry of `columns`, which gives the alignment. Every row is indented by `indent` blanks; two
  /// blanks separate columns.
  explicit TextTable(std::vector<Align> columns, int indent = 2);

  /// Sets the key of the table in JSON. A table without column heads becomes an object with one entry per row.
  void set_name(std::string name) { name_ = std::move(name); }
  /// Sets the key of the table in JSON and the column heads. `keys` are the JSON keys of the columns if they differ from the heads.
  void set_head(std::string name, const std::vector<std::string>& heads, std::vector<std::string> keys = {});
  /// Adds a row. Missing cells are empty.
  void add_row(Row cells);

  [[nodiscard]] bool is_empty() const { return rows_.size() == (keys_.empty() ? 0u : 1u); }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Returns the keys of the columns; empty without heads.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  /// Returns the rows; the first contains the heads, if there are any.
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  friend std::ostream& operator<<(std::ostream& stream, const TextTable& table);

private:
  std::vector<Align> columns_;
  int indent_ = 2;
  std::string name_;
  std::vector<std::string> keys_;
  std::vector<Row> rows_;
};

/// Subject of the tables that follow, for JSON output only; the printed text already names it.
struct About {
  std::string subject;
};
std::ostream& operator<<(std::ostream& stream, const About& about);

/// An output stream that receives tables as objects instead of text.
class TableSink {
public:
  virtual ~TableSink() = default;
  virtual void begin(const About& about) = 0;
  virtual void take(const TextTable& table) = 0;
};

} // namespace steplap
