// Load cases of two models that show one machine in different planes.
//
// A case of one name in both models acts in both planes at the same time. Frictions that the models share (elements/views/friction_plane.h)
// then carry the loads of both, which none of the models sees: their use by both planes is one more limit of the case, in both models. If
// both planes together slip, no model of one plane knows how far, so the verdict on the case cannot be better than "open".
#pragma once

#include "mbd/run/load_cases.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// Runs the cases of both models, those of the first model first. Cases in both planes get the name of their plane. Throws as
/// run_load_cases(), and ModelError for models that share no case or no friction, or that do not state different planes.
[[nodiscard]] LoadCaseResults run_planes(const std::array<std::string, 2>& paths, const std::vector<std::string>& overrides,
                                         const RunCatalogue& catalogue, const RunOptions& options);

} // namespace steplap
