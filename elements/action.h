// `[[action]]`: what happens when a condition comes true (mbd/system/actions.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// The table as a file has it; completion makes an element of it.
[[nodiscard]] const TableKind& action_kind();

} // namespace steplap
