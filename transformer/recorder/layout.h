// Determines the layout of a recorder's file: table, time, axes and units.
//
// The layout is derived only from the head of the file (at most a megabyte) and the options, and applies to the whole file: later rows that
// do not fit are rejected. If the head is ambiguous, the error message names the option that resolves the ambiguity.
#pragma once

#include "transformer/recorder/header.h"
#include "transformer/recorder/read_options.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace steplap {

/// Rules for splitting a line into fields, and properties of the table.
struct TableShape {
  char delimiter = ',';
  char decimal = '.';
  bool joins_pairs = false;                   ///< decimal commas in a file with comma as delimiter: two fields form one number
  bool has_decimals = true;                   ///< false if the head contains whole numbers only
  std::size_t first_data = 0;                 ///< index of the first data row in the head
  std::size_t width = 0;                      ///< number of fields of a full row
  std::size_t most_fields = 0;                ///< number of fields of the longest rows; columns beyond `width` have no name and are omitted
  std::size_t names_line = 0, units_line = 0; ///< line numbers of names and units; 0: none
  std::vector<std::string> names, units;      ///< names and units, one per column, or empty

  /// Splits a line. Returns false if a quote is not closed, or if the number of fields does not form pairs.
  [[nodiscard]] bool split(std::string_view line, std::vector<std::string_view>& fields) const;
};
/// Determines delimiter, decimal sign and names of the table. Throws RecordError if they are ambiguous.
[[nodiscard]] TableShape find_shape(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options);
/// Returns true if the fields look like a row of data, without knowledge of the columns.
[[nodiscard]] bool looks_like_row(const std::vector<std::string_view>& fields);

/// Form in which times are given.
enum class TimeKind { none, number, stamp, date_and_clock };

/// Source of the time of samples.
struct TimeBase {
  TimeKind kind = TimeKind::none;
  std::size_t column = 0, clock_column = 0; ///< indices of the columns of time, and of a separate time of day, from 0
  double factor = 1.0;                      ///< seconds per unit of the numbers
  bool is_relative = false;                 ///< the numbers are counted from the first row (epoch, days)
  unsigned date_order = 1;                  ///< order of the date, one of DateOrder
  std::optional<std::size_t> index_column;  ///< column that counts samples
  double rate = 0.0;                        ///< sampling rate, Hz
  std::string text, rate_text, start;       ///< texts for display; `start` may be ""
};

/// A column with the acceleration of one axis.
struct AxisColumn {
  char axis = 'x';
  std::size_t column = 0;
  std::string heading; ///< heading in the file, or "column 2"
  double factor = 1.0; ///< factor to m/s², sign included
  std::string unit;    ///< unit as in the file
  std::string unit_source;
};

/// Columns of a table of peaks; −1: column does not exist.
struct PeakColumns {
  std::array<int, 3> axis{-1, -1, -1};
  int magnitude = -1, duration = -1, velocity_change = -1;
  double factor = 1.0, duration_factor = 1.0, velocity_factor = 1.0;
  std::string unit;
};

/// Layout of a recorder's file.
struct RecordLayout {
  std::string file, encoding, family;
  TableShape shape;
  TimeBase time;
  std::vector<AxisColumn> axes; ///< at most three, in the order x, y, z; empty for a table of peaks
  bool is_peaks = false;
  PeakColumns peaks;
  bool holds = false; ///< recorder omits samples that equal the one before
  std::string hold_reason;
  std::optional<double> range;    ///< range of the sensor, m/s²
  std::vector<std::string> notes; ///< remarks for the user, one sentence each
};

/// Determines the layout. Throws RecordError if it is ambiguous, unknown or impossible.
[[nodiscard]] RecordLayout find_record_layout(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options);

/// Determines the time base, as part of find_record_layout(). Precondition: `layout` contains shape, axes and family.
[[nodiscard]] TimeBase find_time(const RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata,
                                 const ReadOptions& options, std::vector<std::string>& notes);
/// Returns the index of a column given by name or by number from 1.
[[nodiscard]] std::size_t column_of(const TableShape& shape, const std::string& name_or_number, const std::string& option,
                                    const std::string& file);

} // namespace steplap
