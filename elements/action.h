// Model table `[[action]]`: release, hold or set something when a condition becomes true (mbd/system/actions.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns the kind of table; completion makes an element of each table.
[[nodiscard]] const TableKind& action_kind();

} // namespace steplap
