// Access to fields of a model by path, as in `--set`.
//
//   title                                     a top-level key
//   simulation.step                           a key of a table
//   element.front block.stiffness             a key of a named entry; names may contain blanks and points
//   gravity.1, body.tank.position.0           a component of a point, an item of a list
//   element.spring.force_table.2.1            a component of an item of a list of points
//   parameters.wall                           a parameter, and all values computed from it
// Entries are bodies, markers, signals, elements and other tables ([[core]]). Values are in SI.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Sets a field of a model that is not completed (completion.h), or one component of it, which must be a number; integers accept whole
/// numbers. Setting a parameter also sets all fields that depend on it; a parameter given as a formula cannot be set. References to names
/// are checked later, by completed(). Throws ModelError if the path does not exist, or if the value has the wrong type or is outside the
/// field's range.
void set_value(Model& model, const std::string& path, const FieldValue& value);

/// Returns the value of the field, or a number for a component; text "" for an optional field that is not given. Throws ModelError if the
/// path does not exist.
[[nodiscard]] FieldValue value_of(const Model& model, const std::string& path);

/// Returns the value as a number. Throws ModelError if it is not a number.
[[nodiscard]] double number_of(const Model& model, const std::string& path);

/// Returns the unit of number_of(); "*" if the field accepts any unit. Values of a signal have the unit in which elements and tables take it
/// (signal_use.h). Throws ModelError if the value is not a number.
[[nodiscard]] std::string unit_of(const Model& model, const std::string& path);

} // namespace steplap
