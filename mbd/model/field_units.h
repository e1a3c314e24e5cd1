// Units that hang on other fields of the same object.
//
// Field::unit "N m|N" is that of an angle's quantity and of a length's: which of them, says the object's field
// 'coordinate' ("angle", or any other). Where the object has a field 'as', "velocity" and "acceleration" are per time.
#pragma once

#include "mbd/model/fields.h"

namespace steplap {

/// Does the unit hang on other fields?
[[nodiscard]] bool hangs_on_others(const Field& field);
/// The unit of `field` in `object`, whose fields `table` lists.
[[nodiscard]] std::string unit_in(const FieldTable& table, const Field& field, const void* object);
/// For documents and messages that speak of no object: "N m or N".
[[nodiscard]] std::string shown_unit(const Field& field);

} // namespace steplap
