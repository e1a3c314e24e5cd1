// Feet that press beyond the outline of what they stand on: a unilateral contact's line has no ends, a part does.
#pragma once

#include "tools/steplap/run.h"

namespace steplap {

/// A sentence for each contact that is closed at `state` further along its line than the outline of body b reaches;
/// bodies without an outline say nothing.
[[nodiscard]] std::vector<std::string> feet_beyond_edges(const LoadedModel& loaded, const State& state);

} // namespace steplap
