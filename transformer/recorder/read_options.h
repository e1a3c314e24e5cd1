// What a user settles of a recorder's file that the file does not say, or says wrongly.
#pragma once

#include <optional>
#include <string>

namespace steplap {

enum class IfMissing { refuse, skip, hold };   ///< a field of an axis that is empty or NaN
enum class IfRepeated { refuse, first, last }; ///< a time that is that of the row before: which of the rows is kept
enum class IfBackward { refuse, split, drop }; ///< a time before that of the row before

struct ReadOptions {
  /// Columns by name or by number from 1; a "-" before turns the sign. If any is given, the others are not read.
  std::optional<std::string> x, y, z;
  std::optional<std::string> time;      ///< column by name or number; "none": there is none
  std::optional<std::string> time_unit; ///< "s", "ms", …, "epoch", "epoch ms", "days"
  std::optional<double> rate;           ///< Hz
  std::optional<std::string> unit;      ///< of all axes
  std::optional<double> counts_per_g;
  std::optional<double> range;   ///< m/s², where the sensor ends; none: as the file says
  std::optional<char> delimiter; ///< ',', ';', '\t' or ' '
  std::optional<char> decimal;   ///< '.' or ','
  std::optional<unsigned> dates; ///< one of DateOrder
  IfMissing missing = IfMissing::refuse;
  IfRepeated repeated = IfRepeated::refuse;
  IfBackward backward = IfBackward::refuse;
  bool holds = false; ///< samples that are left out have the value before them
  double gap = 3.5;   ///< in sampling intervals: what is longer splits the record
};

} // namespace steplap
