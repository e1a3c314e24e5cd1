// Contact of the convex outline of a with that of b, or with a half-plane of b (the ground), for boxes that stack, tip and fall. Contact
// points follow from the motion and need not be defined.
//
// Normal force: from an energy of the overlap (outline_overlap.h). The overlap of two convex outlines is one piece and makes one contact.
// It is open if a face of one outline separates them, otherwise pressed.
//
// Friction, if given, sticks exactly along one row, as in coulomb_stick. The touching parts of both bodies are on one line, so that a
// single tangential coordinate is sufficient. This line is the face, of either body, with the least penetration. The contact point is a
// point of the other body: the corner behind the face, or the middle of an edge whose corners are both behind it. Changes of face or point
// are events ("changes foot"). A face is kept until its penetration is twice that of another, which prevents alternation between equal
// faces.
//
// Valid for overlaps that are small compared with the parts; beyond half of the thickness the force pushes the wrong way.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

struct PolygonContact : Element {
  std::string a, b = "ground";
  std::vector<Vec2> outline_a, outline_b; ///< corners, m, in the markers' axes; empty: outline of the body
  std::optional<Vec2> normal;             ///< b is the half-plane behind the line through marker b with this normal
  double stiffness = 0.0;                 ///< force per overlap width and depth, N/m²
  double dissipation = 0.0;               ///< Hunt–Crossley α, s/m
  std::optional<double> static_friction, kinetic_friction;
  std::string source; ///< origin of the values above, quoted in results where the values are unusual
};

[[nodiscard]] const ElementKind& polygon_contact_kind();

/// Adds the fields of the contact law to the kind of T, which has the members of PolygonContact from `stiffness` on.
template <class T> void add_contact_law(FieldTable& fields) {
  fields.add("stiffness", &T::stiffness)
      .in("N/m^2")
      .positive()
      .required()
      .doc("pressure of faces on each other for each metre of depth: k of a width w is w times this");
  fields.add("dissipation", &T::dissipation).in("s/m").not_negative().doc("Hunt-Crossley: factor 1 - alpha d'");
  fields.add("static_friction", &T::static_friction).not_negative().doc("mu_s; default: no friction");
  fields.add("kinetic_friction", &T::kinetic_friction).not_negative().doc("mu_k; default: mu_s");
  fields.add("source", &T::source)
      .doc("where the coefficients come from: above 0.8 results name it, from 1.2 on no verdict is hold without it");
}
/// Returns what is wrong with the coefficients as an error message; "" if nothing is.
[[nodiscard]] std::string friction_problem(std::optional<double> static_friction, std::optional<double> kinetic_friction);

} // namespace steplap
