// Large scenes: a grid of 40 000 masses has 880 000 channels. Searching the extremes of all takes longer than the run, and writing them
// longer than reading the model.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

#include <cstddef>

namespace steplap {

/// Number of channels above which a scene counts as large.
inline constexpr std::size_t k_large_scene = 100'000;

/// In a large scene that nothing judges, restricts extremes (Channel::has_extremes) to channels that are plotted, named in `channels` or
/// `also` of [output], or formulas, and to margins and uses of friction and strength. Scenes with actions are left as they are.
void restrict_extremes(const Model& model, System& system);
/// Returns true if the channel has no extremes in a scene of `count` channels because nothing asks for them.
[[nodiscard]] bool is_not_asked(const Channel& channel, std::size_t count);

} // namespace steplap
