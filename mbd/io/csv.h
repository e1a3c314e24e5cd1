// Tables of numbers as CSV: records read in, histories written out.
//
// Reading: the delimiter is a tab, a semicolon or a comma (the first of them that the first row
// holds); with a semicolon or a tab a decimal comma is understood. Lines that are empty or start
// with # are skipped; a first row that does not begin with a number holds the names of the columns (with or
// without quotes, a unit in brackets after the name is not part of it: "time [s]").
#pragma once

#include "mbd/base/diagnostics.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace steplap {

struct CsvTable {
  std::string file;
  std::vector<std::string> names;           ///< of the columns, empty without a header row
  std::vector<std::vector<double>> columns; ///< all of one length
  std::vector<int> lines;                   ///< line of the file for each row

  /// Index of a column given by name or by number (from 1). Throws ModelError at `where`.
  [[nodiscard]] std::size_t column(const std::string& name_or_number, const Location& where) const;
};

/// Throws ModelError with file:line: for a file that cannot be read (at `where`), rows of unequal
/// length, fields that are no finite number, a first row that mixes words and numbers, and a file without rows; and, if
/// `wanted` is not empty, for a file with another SHA-256.
[[nodiscard]] CsvTable read_csv(const std::string& path, const Location& where, const std::string& wanted = "");
[[nodiscard]] CsvTable parse_csv(const std::string& text, const std::string& file_name);

/// Comma-separated text, shortest digits that read back as the same numbers, "\n" after each row.
class CsvText {
public:
  /// `rows`: how many will come, if known: room is made for them at once.
  explicit CsvText(std::span<const std::string> names, std::size_t rows = 0);
  void add_row(std::span<const double> values);
  /// A line that readers skip; begins with #.
  void add_comment(const std::string& line) { text_ += line + "\n"; }
  /// After what there is has been written: more rows follow.
  void clear() {
    text_.clear();
    last_.clear();
  }
  [[nodiscard]] const std::string& text() const& { return text_; }
  [[nodiscard]] std::string text() && { return std::move(text_); }

private:
  struct Field { ///< of the row before
    std::uint64_t bits = 0;
    std::size_t start = 0, length = 0; ///< in the text, with what follows it
  };
  std::string text_;
  std::vector<char> row_;   ///< the one being written
  std::vector<Field> last_; ///< none at first
};

/// A field as CSV wants it: quoted if it holds a comma, a quote or a line break.
[[nodiscard]] std::string csv_field(const std::string& text);

} // namespace steplap
