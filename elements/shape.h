// [[shape]]: a body's mass, centre of gravity and inertia from its outline.
//
//   [[shape]]
//   name = "plate"
//   body = "bracket"
//   holes = [[[0.1, 0.1], [0.2, 0.1], [0.2, 0.2]]]
//   hole_centres = [[0.05, 0.02]]
//   hole_diameters = ["18 mm"]
//   density = "7850 kg/m^3"
//   thickness = "20 mm"
//
// A shape is one area in the body's frame, an outline or a disc, with holes, and of one mass per area. Shapes of a body add up, also
// where they lie one on the other. What the body gives itself holds; the rest comes from its shapes: of a given mass the inertia is
// the shapes', in proportion. By Green's theorem an area's moments are sums over its edges,
//   A = ½ Σ c,  A x = ⅙ Σ (p_x + q_x) c,  J = 1/12 Σ (p·p + p·q + q·q) c,   c = p × q for an edge from p to q,
// here about the ring's first corner, so that no digits are lost far from the origin; a disc has A = π d²/4, J = A d²/8.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct BodyShape : TableObject {
  std::string body;
  std::vector<Vec2> outline;            ///< m, body frame; empty: the body's
  Vec2 centre = Vec2::Zero();           ///< m, of a disc
  std::optional<double> diameter;       ///< m, of a disc
  std::vector<std::vector<Vec2>> holes; ///< m, rings of corners, either sense
  std::vector<Vec2> hole_centres;       ///< m, of round holes
  std::vector<double> hole_diameters;   ///< m, one for all or one for each
  std::optional<double> density;        ///< kg/m³, with thickness
  std::optional<double> thickness;      ///< m
  std::optional<double> area_density;   ///< kg/m²
  std::optional<double> mass;           ///< kg, of the shape without its holes
};

/// Of a body: its mass, centre of gravity in its frame, and inertia about that.
struct MassOfShapes {
  double mass = 0.0;
  Vec2 centre = Vec2::Zero();
  double inertia = 0.0;
};

/// Of all shapes of the body. Nothing if it has none. `given_mass` is what a shape that says nothing of its mass has, if it is the only
/// one. Throws ModelError for shapes that are none, or that do not say what they weigh.
[[nodiscard]] std::optional<MassOfShapes> mass_of_shapes(const Model& model, const Body& body, double given_mass);

struct ShapeRemark {
  Location where;
  std::string text;
};
/// Of a completed model: what bodies give themselves and their shapes make otherwise, by more than a hundredth.
[[nodiscard]] std::vector<ShapeRemark> contradicted_shapes(const Model& model);

[[nodiscard]] const TableKind& shape_kind();

} // namespace steplap
