// Bushing: springs and dampers along x and y of marker b and about it, between two coincident markers (theory.md §2).
//
// Force on a for each of the three coordinates, in the frame of b: −k δ − c δ̇. The opposite acts on b.
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
