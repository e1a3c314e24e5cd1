// Tables of numbers as CSV: reads records, writes histories.
//
// The delimiter is a tab, a semicolon or a comma: the first of these in this order that occurs in the first row. With tab or semicolon, a
// decimal comma is accepted. Empty lines and lines that start with # are skipped. A first row that does not begin with a number contains
// the column names, with or without quotes. A unit in brackets is not part of a name: "time [s]".
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
  std::vector<std::string> units;           ///< in brackets after the names, "" where there is none; empty without a header row
  std::vector<std::vector<double>> columns; ///< equal lengths
  std::vector<int> lines;                   ///< line number in the file, for each row

  /// Returns the index of the column with this name, or with this number counted from 1. Throws ModelError at `where` if there is none.
  [[nodiscard]] std::size_t column(const std::string& name_or_number, const Location& where) const;
};

/// Reads a file. Throws ModelError at `where` if it cannot be read, or if its SHA-256 differs from `wanted`, unless that is empty. Throws
/// ModelError with file:line for rows of unequal length, fields that are not finite numbers, a first row that mixes words and numbers, and
/// a file without rows.
[[nodiscard]] CsvTable read_csv(const std::string& path, const Location& where, const std::string& wanted = "");
[[nodiscard]] CsvTable parse_csv(const std::string& text, const std::string& file_name);

/// Returns the names and units of the columns of a file, whose rows are not read. There are no columns if the file cannot be read twice, as
/// a pipe, or if its first row is neither names nor numbers: read_csv() reports the errors.
[[nodiscard]] CsvTable read_csv_header(const std::string& path);

/// CSV text with comma delimiter and "\n" after each row. Numbers have the fewest digits that read back exactly.
class CsvText {
public:
  /// `rows`: expected number of rows, for which memory is reserved; 0 if unknown.
  explicit CsvText(std::span<const std::string> names, std::size_t rows = 0);
  void add_row(std::span<const double> values);
  /// Adds a line that readers skip; it must begin with #.
  void add_comment(const std::string& line) { text_ += line + "\n"; }
  /// Clears the text after it has been written; further rows may follow.
  void clear() {
    text_.clear();
    last_.clear();
  }
  [[nodiscard]] const std::string& text() const& { return text_; }
  [[nodiscard]] std::string text() && { return std::move(text_); }

private:
  struct Field { ///< position of a field in the previous row
    std::uint64_t bits = 0;
    std::size_t start = 0, length = 0; ///< position in the text, including the delimiter
  };
  std::string text_;
  std::vector<char> row_;   ///< row being written
  std::vector<Field> last_; ///< fields of the previous row; empty before the first
};

/// Returns the text as a CSV field: in quotes if it contains a comma, a quote, a line break, or a # that would begin a comment.
[[nodiscard]] std::string csv_field(const std::string& text);

} // namespace steplap
