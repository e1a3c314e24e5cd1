// Units of fields that depend on other fields of the same object.
//
// Field::unit "N m|N" gives two alternatives, for an angle and for a length. The object's field 'coordinate' selects between them ("angle"
// or any other value). If the object has a field 'as', the values "velocity" and "acceleration" divide the unit by s and s².
#pragma once

#include "mbd/model/fields.h"

namespace steplap {

/// Returns true if the unit of `field` depends on other fields.
[[nodiscard]] bool depends_on_other_fields(const Field& field);
/// Returns the unit of `field` for the values in `object`, whose fields `table` lists.
[[nodiscard]] std::string unit_in(const FieldTable& table, const Field& field, const void* object);
/// Returns the unit for any object, as shown in documents and messages: "N m or N".
[[nodiscard]] std::string shown_unit(const Field& field);

} // namespace steplap
