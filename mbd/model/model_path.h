// Fields of a model by their paths, as `--set` writes them.
//
//   title                                     a top-level key
//   simulation.step                           a key of a table
//   element.front block.stiffness             a key of a named entry; names may hold blanks and points
//   gravity.1, body.tank.position.0           a component of a point, an item of a list
//   element.spring.force_table.2.1            of a list of points
//   parameters.wall                           a parameter, and with it all that follows from it
// Entries are bodies, markers, signals, elements and other tables ([[core]]). Values are in SI.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Sets a field of a model as given (completion.h) to a value of the field's type, or to a number where that is one
/// of its components; whole numbers serve for integers. Throws ModelError if the path leads nowhere, the value is of
/// another type, or out of the field's range. That names refer to something is left to completed(). Of parameters only free ones
/// can be set; every field whose formula needs one is set with it.
void set_value(Model& model, const std::string& path, const FieldValue& value);

/// What the field holds; a number for a component. Text "" stands for an optional field that is not given.
[[nodiscard]] FieldValue value_of(const Model& model, const std::string& path);

/// The same where that is a number. Throws ModelError if it is none.
[[nodiscard]] double number_of(const Model& model, const std::string& path);

/// The unit of that number: "*" where any will do. Throws ModelError if the path leads to no number.
[[nodiscard]] std::string unit_of(const Model& model, const std::string& path);

} // namespace steplap
