// What a recorder's file is taken for: its table, its time, its axes and their units.
//
// It is found from the head of the file (a megabyte at most), from the options and from nothing else, and holds for the whole file: a row
// further down that does not fit is refused. What the head leaves open is refused with the name of the option that settles it.
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

/// How a line is parted into fields.
struct TableShape {
  char delimiter = ',';
  char decimal = '.';
  bool joins_pairs = false;                   ///< a decimal comma beside a comma that parts fields: two fields make a number
  bool has_decimals = true;                   ///< false: the head holds whole numbers only
  std::size_t first_data = 0;                 ///< index into the head of the first row of numbers
  std::size_t width = 0;                      ///< fields of a full row
  std::size_t names_line = 0, units_line = 0; ///< 0: there is none
  std::vector<std::string> names, units;      ///< as many as columns, or none

  /// False if a quote is not closed, or pairs do not come out.
  [[nodiscard]] bool split(std::string_view line, std::vector<std::string_view>& fields) const;
};
[[nodiscard]] TableShape find_shape(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options);
/// Is it a row of numbers, as far as one sees without knowing its columns?
[[nodiscard]] bool looks_like_row(const std::vector<std::string_view>& fields);

enum class TimeKind { none, number, stamp, date_and_clock };

/// Where time comes from.
struct TimeBase {
  TimeKind kind = TimeKind::none;
  std::size_t column = 0, clock_column = 0; ///< from 0
  double factor = 1.0;                      ///< s per unit, of numbers
  bool is_relative = false;                 ///< of numbers: counted from the first row (epoch, days)
  unsigned date_order = 1;                  ///< one of DateOrder
  std::optional<std::size_t> index_column;  ///< counts samples
  double rate = 0.0;                        ///< Hz
  std::string text, rate_text, start;       ///< for people; start may be ""
};

struct AxisColumn {
  char axis = 'x';
  std::size_t column = 0;
  std::string heading; ///< as the file names it, or "column 2"
  double factor = 1.0; ///< to m/s², sign included
  std::string unit;    ///< of the file
  std::string unit_source;
};

/// Columns of a table of peaks; −1: there is none.
struct PeakColumns {
  std::array<int, 3> axis{-1, -1, -1};
  int magnitude = -1, duration = -1, velocity_change = -1;
  double factor = 1.0, duration_factor = 1.0, velocity_factor = 1.0;
  std::string unit;
};

struct RecordLayout {
  std::string file, encoding, family;
  TableShape shape;
  TimeBase time;
  std::vector<AxisColumn> axes; ///< at most three, in the order x, y, z; none in a table of peaks
  bool is_peaks = false;
  PeakColumns peaks;
  bool holds = false; ///< left-out samples keep the value before them
  std::string hold_reason;
  std::optional<double> range;    ///< m/s², where the sensor ends
  std::vector<std::string> notes; ///< whole sentences
};

/// Throws RecordError for what is ambiguous, unknown or impossible.
[[nodiscard]] RecordLayout find_record_layout(const std::vector<HeaderLine>& head, const std::string& file, const ReadOptions& options);

/// Used by find_record_layout(): needs shape, axes and family.
[[nodiscard]] TimeBase find_time(const RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata,
                                 const ReadOptions& options, std::vector<std::string>& notes);
/// Column by name or number from 1.
[[nodiscard]] std::size_t column_of(const TableShape& shape, const std::string& name_or_number, const std::string& option,
                                    const std::string& file);

} // namespace steplap
