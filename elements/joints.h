// Bilateral joints between a marker on a and a marker on b: what they forbid, in marker b's axes.
//
//   revolute        both relative displacements of the markers
//   prismatic       displacement across b's axis, and relative rotation
//   weld            both displacements and relative rotation, as in the reference pose
//   distance        change of the distance of the markers (a rod)
//   point_on_line   displacement across b's axis
// Each gives its multipliers as channels: the force on a along the direction held.
#pragma once

#include "mbd/model.h"

namespace steplap {

struct Joint : Element {
  std::string a, b = "ground";
  Vec2 axis{1.0, 0.0};          ///< prismatic, point_on_line: in marker b's axes
  std::optional<double> length; ///< distance
};

[[nodiscard]] const ElementKind& revolute_kind();
[[nodiscard]] const ElementKind& prismatic_kind();
[[nodiscard]] const ElementKind& weld_kind();
[[nodiscard]] const ElementKind& distance_kind();
[[nodiscard]] const ElementKind& point_on_line_kind();

} // namespace steplap
