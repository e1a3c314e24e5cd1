// `[[state]]`: a differential equation of the model's own (mbd/system/own_states.h).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// The table as a file has it; completion makes an element of it.
[[nodiscard]] const TableKind& own_state_kind();

} // namespace steplap
