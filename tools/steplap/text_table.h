// Tables of a command: aligned text on the screen, or names and numbers for programs (json_screen.h). A command makes the table once.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// What stands in a cell: text for people, and for programs the number that the text rounds.
struct Cell {
  std::string text;
  std::optional<double> value = {}; ///< SI; not-a-number where there is none although the column has numbers
  std::string unit = {};
  std::optional<double> error = {}; ///< of the value, if it was estimated

  Cell(std::string text_) : text(std::move(text_)) {}
  Cell(const char* text_) : text(text_) {}
  Cell(std::string text_, double value_, std::string unit_ = "", std::optional<double> error_ = {})
      : text(std::move(text_)), value(value_), unit(std::move(unit_)), error(error_) {}
};

/// quantity_text() with the number behind it.
[[nodiscard]] Cell quantity_cell(double value, const std::string& unit);
/// The same; what is rounding beside `scale` is shown as zero.
[[nodiscard]] Cell quantity_cell(double value, const std::string& unit, double scale);
/// measured_text() with the number behind it.
[[nodiscard]] Cell measured_cell(double value, std::optional<double> error, const std::string& unit);
[[nodiscard]] Cell count_cell(std::size_t count);

/// Columns as wide as their widest cell (counted in characters, not bytes).
class TextTable {
public:
  enum class Align { left, right };
  using Row = std::vector<Cell>;

  /// `indent` blanks before every row, two between columns; `columns` tells how each is aligned.
  explicit TextTable(std::vector<Align> columns, int indent = 2);

  /// What programs call the table. Without a head its rows are pairs of a name and what is said of it.
  void set_name(std::string name) { name_ = std::move(name); }
  /// The same, and a first row with the heads of the columns. `keys`: what programs call the columns, where that is not the head.
  void set_head(std::string name, const std::vector<std::string>& heads, std::vector<std::string> keys = {});
  /// Missing cells are empty.
  void add_row(Row cells);

  [[nodiscard]] bool is_empty() const { return rows_.size() == (keys_.empty() ? 0u : 1u); }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Of the columns; empty without a head.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  /// The head, if there is one, is the first.
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  friend std::ostream& operator<<(std::ostream& stream, const TextTable& table);

private:
  std::vector<Align> columns_;
  int indent_ = 2;
  std::string name_;
  std::vector<std::string> keys_;
  std::vector<Row> rows_;
};

/// What the tables that follow are about, for programs; people read it in the text.
struct About {
  std::string subject;
};
std::ostream& operator<<(std::ostream& stream, const About& about);

/// A stream that takes tables as they are instead of their text.
class TableSink {
public:
  virtual ~TableSink() = default;
  virtual void begin(const About& about) = 0;
  virtual void take(const TextTable& table) = 0;
};

} // namespace steplap
