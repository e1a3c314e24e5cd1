// Model table [[shape]]: mass, centre of gravity and inertia of a body from its outline.
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
// A shape is an area in the body's frame, an outline or a disc, with holes and a uniform mass per area. Shapes of one body add up, even
// where they overlap. Values given for the body itself have priority; the others are computed from its shapes. For a given mass the inertia
// is scaled accordingly. The moments of an area are sums over its edges (Green's theorem):
//
//   A = ½ Σ c,  A x = ⅙ Σ (p_x + q_x) c,  J = 1/12 Σ (p·p + p·q + q·q) c,   c = p × q for an edge from p to q,
//
// relative to the ring's first corner, so that no accuracy is lost far from the origin. A disc has A = π d²/4, J = A d²/8.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct BodyShape : TableObject {
  std::string body;
  std::vector<Vec2> outline;            ///< corners in the body frame, m; empty: outline of the body
  Vec2 centre = Vec2::Zero();           ///< centre of a disc, m
  std::optional<double> diameter;       ///< diameter of a disc, m
  std::vector<std::vector<Vec2>> holes; ///< rings of corners, m, in either order
  std::vector<Vec2> hole_centres;       ///< centres of round holes, m
  std::vector<double> hole_diameters;   ///< diameters, m, one for all holes or one for each
  std::optional<double> density;        ///< density, kg/m³; requires thickness
  std::optional<double> thickness;      ///< thickness, m
  std::optional<double> area_density;   ///< mass per area, kg/m²
  std::optional<double> mass;           ///< mass of the shape without its holes, kg
};

/// Mass, kg, centre of gravity, m, in the body's frame, and inertia about it, kg m².
struct MassOfShapes {
  double mass = 0.0;
  Vec2 centre = Vec2::Zero();
  double inertia = 0.0;
};

/// Returns the sum of all shapes of the body, or nothing if it has none. `given_mass`: mass of the body, for a single shape without a mass
/// of its own. Throws ModelError for invalid shapes, or if a mass is missing.
[[nodiscard]] std::optional<MassOfShapes> mass_of_shapes(const Model& model, const Body& body, double given_mass);

/// A contradiction between the values of a body and those of its shapes.
struct ShapeRemark {
  Location where;
  std::string text;
};
/// Returns remarks for all bodies of a completed model whose given values differ from those of their shapes by more than 1 %.
[[nodiscard]] std::vector<ShapeRemark> contradicted_shapes(const Model& model);

[[nodiscard]] const TableKind& shape_kind();

} // namespace steplap
