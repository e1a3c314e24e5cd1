// The small vibrations of a model as a page: its drawing at rest, moving in the mode that is chosen.
#pragma once

#include "mbd/rest/modes.h"
#include "run/loaded_model.h"

#include <string>
#include <vector>

namespace steplap {

/// One HTML file that needs no other file and no network. `moves_most`: a text for each mode.
[[nodiscard]] std::string modes_page(const LoadedModel& loaded, const Equilibrium& rest, const VibrationModes& found,
                                     const std::vector<std::string>& moves_most, const std::vector<std::string>& remarks);

} // namespace steplap
