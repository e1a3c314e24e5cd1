// steplap record: a shock recorder's file read, what it was taken for, its events, and signals that a model can use.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

[[nodiscard]] Command record_command();

} // namespace steplap
