// Polygon contact: the convex outline of a against that of b, or against a half-plane of b (the ground). Boxes stack, tip and
// fall: corners and edges touch wherever they come, nothing is said beforehand of feet.
//
// Normal force: outline_overlap.h, from an energy of the overlap; one contact for the whole overlap, which of two convex
// outlines is one piece. It is open, or pressed while no face of one has the other before it.
//
// Friction, if given, sticks exactly along one row, as coulomb_stick does: the touching parts of both bodies lie on one line, so
// that one tangential coordinate serves them and no load has to be shared between corners. The line is that face, of
// either body, which the other enters least; the point that is held on it belongs to the other body: its corner behind the
// face, or the middle of the edge both corners of which are. Both change with located events ("changes foot"). A face keeps
// its part until it is entered twice as deep as another, so that a tie does not go to and fro.
//
// Valid while overlaps are small against the parts: beyond half of the thickness the way out is another one.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct PolygonContact : Element {
  std::string a, b = "ground";
  std::vector<Vec2> outline_a, outline_b; ///< in the markers' axes; empty: the body's own
  std::optional<Vec2> normal;             ///< b is the half-plane behind the line through marker b
  double stiffness = 0.0;                 ///< N/m²
  double dissipation = 0.0;               ///< Hunt–Crossley α
  std::optional<double> static_friction, kinetic_friction;
  std::string source; ///< origin of these values; results name it where the values are unusual
};

[[nodiscard]] const ElementKind& polygon_contact_kind();

} // namespace steplap
