// Sets of quasi-static transport loads: constant accelerations of the vehicle, each with its direction.
//
// A vehicle with acceleration a exerts −a per unit of mass on its load. Presets list this pull, in addition to gravity: a braking vehicle
// pulls forward. x points forward in a model of the lengthwise plane and to one side in a model of the transverse plane; y points up.
#pragma once

#include "mbd/base/types.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Vertical plane of the vehicle in which a model lies: along or across it.
enum class Plane { lengthwise, transverse };
/// Returns "lengthwise" or "transverse".
[[nodiscard]] const char* name_of(Plane plane);

/// One load case: a constant pull.
struct StaticLoad {
  std::string name;         ///< "forward"
  Vec2 pull = Vec2::Zero(); ///< pull, m/s², in addition to gravity
  std::string plane;        ///< plane of the models to which the load applies; "" if it applies to both
};

/// A named set of loads with its source.
struct StaticPreset {
  std::string name, source;
  std::vector<StaticLoad> loads;
};

/// Returns the presets built into the program.
[[nodiscard]] const std::vector<StaticPreset>& static_presets();
/// Returns a preset by its name, or reads it from a file whose name ends with ".toml". Throws ModelError with location and remedy.
[[nodiscard]] StaticPreset static_preset(const std::string& name_or_file);
/// Returns the loads for models of this plane, in their order. Throws std::invalid_argument if there is none.
[[nodiscard]] std::vector<StaticLoad> loads_for(const StaticPreset& preset, Plane plane);
/// Returns true if some load applies to one plane only.
[[nodiscard]] bool depends_on_plane(const StaticPreset& preset);

} // namespace steplap::assess
