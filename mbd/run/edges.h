// Finds contacts that have left their part: pressed beyond the end of the outline that supports them (endless_face.h), or deeper than the
// outline is thick.
#pragma once

#include "mbd/run/finding.h"
#include "mbd/run/loaded_model.h"
#include "mbd/simulation/simulation.h"

namespace steplap {

/// Returns one finding for each contact that is closed at `state` and presses beyond the end of its part. Parts without an outline have no
/// end.
[[nodiscard]] std::vector<Finding> contacts_beyond_edges(const LoadedModel& loaded, const State& state);

/// Returns one finding for each contact that pressed beyond the end of its part at any time of the run.
[[nodiscard]] std::vector<Finding> contacts_beyond_edges(const LoadedModel& loaded, const RunResult& result);

/// Returns one finding for each contact whose largest penetration in the run exceeds ContactDescription::depth_limit, or, without a limit,
/// a fifth of the size of the smaller body.
[[nodiscard]] std::vector<Finding> contacts_too_deep(const LoadedModel& loaded, const std::vector<ChannelRange>& ranges);

} // namespace steplap
