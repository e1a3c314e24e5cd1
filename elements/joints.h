// Bilateral joints between a marker on a and a marker on b. Constrained quantities, in marker b's axes:
//
//   revolute        both relative displacements of the markers
//   prismatic       displacement across b's axis, and relative rotation
//   weld            both displacements and relative rotation, as in the reference pose
//   distance        change of the distance of the markers (a rod)
//   point_on_line   displacement across b's axis
//
// The multipliers are channels: the force on a along the constrained direction. A revolute, prismatic or weld joint with a given coordinate
// determines the reference pose of one body relative to the other (mbd/model/placement.h).
#pragma once

#include "mbd/model/placement.h"

namespace steplap {

struct Joint : PlacingElement {
  Vec2 axis{1.0, 0.0};          ///< prismatic, point_on_line: direction in marker b's axes
  std::optional<double> length; ///< distance: length of the rod, m
  // Given reference pose of marker a relative to marker b; determines the pose of one body.
  std::optional<double> angle;            ///< for revolute, prismatic, weld; rad
  std::optional<double> angular_velocity; ///< for revolute; rad/s
  std::optional<double> displacement;     ///< for prismatic: along the axis, m
  std::optional<double> speed;            ///< for prismatic: along the axis, m/s

  [[nodiscard]] std::optional<RelativePose> relative_pose() const override;
  [[nodiscard]] const char* placing_field() const override { return is_slide ? "displacement" : "angle"; }
  [[nodiscard]] const char* idle_field() const override;
  bool is_slide = false; ///< true for prismatic: a given `displacement` determines a pose
};

[[nodiscard]] const ElementKind& revolute_kind();
[[nodiscard]] const ElementKind& prismatic_kind();
[[nodiscard]] const ElementKind& weld_kind();
[[nodiscard]] const ElementKind& distance_kind();
[[nodiscard]] const ElementKind& point_on_line_kind();

} // namespace steplap
