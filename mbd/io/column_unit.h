// Unit of a column of a table of measurements: given by the user, or in brackets in the header.
#pragma once

#include "mbd/io/csv.h"

#include <string>

namespace steplap {

/// Value in the wanted unit: factor · number + shift.
struct UnitConversion {
  double factor = 1.0, shift = 0.0;
};

/// A column, and the unit that the user gives for it.
struct ColumnUnit {
  std::string owner;  ///< of the column in messages, such as "record 'rail'"
  std::string key;    ///< name of the field that gives the unit; "": there is none
  std::string given;  ///< unit; "": the one in the header
  Location where;     ///< of the owner in its file
  std::string wanted; ///< unit to convert to; "*": SI base units of whatever unit is given
};

/// Returns the conversion of a column. Without a unit its numbers are in the wanted one. [g] is the gravity of the earth except for times and
/// masses. Throws ModelError if the unit is unknown or of another quantity, if both units are there and differ, or if a unit may be in
/// parentheses.
[[nodiscard]] UnitConversion conversion_of(const CsvTable& table, std::size_t column, const ColumnUnit& unit);

/// Returns the unit in brackets in the header of a column, as parse_quantity() reads it; "" if there is none. [g] as in conversion_of().
[[nodiscard]] std::string unit_in_header(const CsvTable& table, std::size_t column, const std::string& wanted);

/// Returns the unit in brackets in the header of a column of a file, as conversion_of() takes it for any unit; "" if there is none, if it is
/// unknown, or if there is no such column. Throws ModelError if the unit database is missing.
[[nodiscard]] std::string unit_in_file(const std::string& path, const std::string& column);

} // namespace steplap
