// Model table [[contacts]]: contact between the outlines of groups of bodies, for crowds whose pairs nobody wants to list.
//
//   [[contacts]]
//   name = "pile"
//   a = ["stone *"]
//   b = ["ground", "stone *"]
//   stiffness = "1 GN/m2"
//
// Each pair of a body of `a` with one of `b` becomes the polygon_contact "pile.stone 2 on stone 1", once. The body that comes later in the
// model is its a if both are in both groups. The run is that of a model that lists the same pairs.
#pragma once

#include "mbd/model/body_builder.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct ContactGroup : BodyBuilder {
  std::vector<std::string> a; ///< patterns of names of bodies
  std::vector<std::string> b; ///< the same, "ground", or names of markers
  std::optional<Vec2> normal; ///< as in PolygonContact, whose fields follow
  double stiffness = 0.0;     ///< N/m²
  double dissipation = 0.0;   ///< Hunt–Crossley α
  std::optional<double> static_friction, kinetic_friction;
  std::string source;

  void add_bodies(Model& model) const override;
};

[[nodiscard]] const TableKind& contact_group_kind();

} // namespace steplap
