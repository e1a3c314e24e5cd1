// Where bodies stand on each other: a point for each foot, wheel or corner that touches.
#pragma once

#include "run/loaded_model.h"

namespace steplap {

/// A place of contact. Of outlines whose faces lie on each other there are two, at the ends of the common part.
struct Foot {
  std::string element;            ///< name of the contact
  std::string name;               ///< of it, and which end of the face
  int a = k_ground, b = k_ground; ///< bodies of the system
  Vec2 point = Vec2::Zero();      ///< m, ground axes
  Vec2 normal = Vec2::Zero();     ///< of the force on a
};

/// Of all contacts that are closed in `state`, or open by less than a thousandth of the bodies' size: a pose as it is given
/// has its contacts just touching.
[[nodiscard]] std::vector<Foot> feet_of(const LoadedModel& loaded, const State& state);

} // namespace steplap
