// Bushing: springs and dampers along x and y of marker b and about it, between two markers that lie
// together (physics.md §2). Forces on a: −k δ − c δ̇ for each of the three, in the frame of b.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Bushing : Element {
  std::string a, b = "ground";
  Vec2 stiffness = Vec2::Zero(), damping = Vec2::Zero();
  double rotational_stiffness = 0.0, rotational_damping = 0.0;
};

[[nodiscard]] const ElementKind& bushing_kind();

} // namespace steplap
