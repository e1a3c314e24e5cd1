// Creates a page that shows the vibration modes of a model as animations of its drawing.
#pragma once

#include "mbd/rest/modes.h"
#include "mbd/run/loaded_model.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns a self-contained HTML file. `moves_most`: for each mode a text with the names of the bodies that move most.
[[nodiscard]] std::string modes_page(const LoadedModel& loaded, const Equilibrium& rest, const VibrationModes& found,
                                     const std::vector<std::string>& moves_most, const std::vector<std::string>& remarks);

} // namespace steplap
