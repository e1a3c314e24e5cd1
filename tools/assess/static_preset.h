// Quasi-static loads that a machine has to stand in transit: accelerations of what it stands on, each with its direction, taken
// as constant.
//
// A vehicle that accelerates with a pulls everything on it with −a per unit of mass. This pull is what a preset lists, beside gravity: a
// vehicle that brakes pulls forward. x points forward in a model of the lengthwise plane and to one side in one of the
// transverse plane, y points up.
#pragma once

#include "mbd/base/types.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Which section of the machine a model shows.
enum class Plane { lengthwise, transverse };
/// "lengthwise" or "transverse".
[[nodiscard]] const char* name_of(Plane plane);

/// One load.
struct StaticLoad {
  std::string name;         ///< "forward"
  Vec2 pull = Vec2::Zero(); ///< m/s², beside gravity
  std::string plane;        ///< of models that it is for, "" for both
};

/// Loads with their source.
struct StaticPreset {
  std::string name, source;
  std::vector<StaticLoad> loads;
};

/// Those that the program knows by name.
[[nodiscard]] const std::vector<StaticPreset>& static_presets();
/// By its name, or read from a file whose name ends with ".toml". Throws ModelError with place and remedy.
[[nodiscard]] StaticPreset static_preset(const std::string& name_or_file);
/// Those for models of the plane, in their order. Throws std::invalid_argument if there is none.
[[nodiscard]] std::vector<StaticLoad> loads_for(const StaticPreset& preset, Plane plane);
/// Does it make a difference between the planes?
[[nodiscard]] bool depends_on_plane(const StaticPreset& preset);

} // namespace steplap::assess
