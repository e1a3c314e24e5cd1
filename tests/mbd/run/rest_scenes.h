// Random scenes that are at rest, or held while a load acts below what they bear: all of them are sound, and every criterion is met.
#pragma once

#include <cstdint>
#include <string>

namespace steplap::testing {

struct RestScene {
  std::string kind, method, load; ///< "slope", "moreau", "pulse"
  std::string text;               ///< the model as TOML
};

/// Stiffness of 1e4 to 1e10 N/m, masses of 1e-3 to 1e6 kg, lengths of 1e-3 to 1e2 m, runs of up to 100 s and 1e4 times of the stiffest
/// spring, at random angles. Weight moves a body by at most a thousandth of its size: from there on stiffness is too little for it.
[[nodiscard]] RestScene random_rest_scene(std::uint64_t seed);

} // namespace steplap::testing
