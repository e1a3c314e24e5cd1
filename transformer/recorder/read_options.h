// Options by which a user supplies or corrects information about a recorder's file.
#pragma once

#include <array>
#include <optional>
#include <string>

namespace steplap {

enum class IfMissing { refuse, skip, hold };   ///< treatment of an empty or NaN field of an axis
enum class IfRepeated { refuse, first, last }; ///< treatment of a row with the same time as the row before: which of the two rows is kept
enum class IfBackward { refuse, split, drop }; ///< treatment of a row with a time before that of the row before

/// Options for reading a file. Options that are not given are determined from the file.
struct ReadOptions {
  /// Columns by name or by number from 1; a leading "-" reverses the sign. If any is given, axes that are not given are not read.
  std::optional<std::string> x, y, z;
  std::optional<std::string> time;      ///< column by name or number; "none": the file has no time column
  std::optional<std::string> time_unit; ///< "s", "ms", …, "epoch", "epoch ms", "days"
  std::optional<double> rate;           ///< sampling rate, Hz
  std::optional<std::string> unit;      ///< unit of all axes
  std::optional<double> counts_per_g;
  std::optional<double> range;               ///< range of the sensor, m/s²; none: as in the file
  std::optional<std::array<double, 2>> rest; ///< interval of the record at rest, s; none: its first second
  std::optional<char> delimiter;             ///< delimiter: ',', ';', '\t' or ' '
  std::optional<char> decimal;               ///< decimal sign: '.' or ','
  std::optional<unsigned> dates;             ///< order of dates, one of DateOrder
  IfMissing missing = IfMissing::refuse;
  IfRepeated repeated = IfRepeated::refuse;
  IfBackward backward = IfBackward::refuse;
  bool holds = false; ///< the recorder omits samples that equal the one before
  double gap = 3.5;   ///< longest gap within a segment, in sampling intervals; longer gaps split the record into segments
};

} // namespace steplap
