// Model table `[[state]]`: a variable with its own differential equation (mbd/system/own_states.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns the kind of table; completion makes an element of each table.
[[nodiscard]] const TableKind& own_state_kind();

/// Returns the kind of these elements. Elements in files cannot have it.
[[nodiscard]] const ElementKind& own_state_element_kind();

} // namespace steplap
