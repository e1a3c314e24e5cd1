// What a record lacks for a decision that rests on it.
#pragma once

#include "tools/assess/record_events.h"

namespace steplap::assess {

/// Of a record that was read, without its events: fills its faults.
void find_faults(RecordEvents& record);

} // namespace steplap::assess
