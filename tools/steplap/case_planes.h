// Load cases of two models that show one machine in different planes.
//
// A case with the same name in both models acts in both planes simultaneously. Frictions that the models share
// (elements/views/friction_plane.h) then carry the loads of both planes, but each model computes one plane only. The combined utilisation
// is therefore checked as an additional limit of the case in both models. If the combined load causes slip, neither model can compute the
// slide, so the verdict on the case cannot be better than "open".
#pragma once

#include "mbd/run/load_cases.h"

#include <array>
#include <string>
#include <vector>

namespace steplap {

/// Runs the load cases of both models, first those of the first model. The names of cases that act in both planes are extended by the
/// plane. Throws as run_load_cases(), and ModelError if the models have no common case or no common friction, or do not state different
/// planes.
[[nodiscard]] LoadCaseResults run_planes(const std::array<std::string, 2>& paths, const std::vector<std::string>& overrides,
                                         const RunCatalogue& catalogue, const RunOptions& options);

} // namespace steplap
