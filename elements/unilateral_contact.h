// Unilateral contact of a marker on a with a line on b, for feet, plates, wooden blocks (the H(−δ) terms of Eqs. (2), (4)).
//
// Gap δ = n·(p_A − p_B)/(n·a) − offset, contact for δ < 0; the force acts at the tip p_A − δ a along n/(n·a). The contact axis a is the
// normal, or fixed in body a (a shaft whose tip is on b's line, as the foot of Eq. 8). Laws: Kelvin–Voigt without adhesion f = max(0, −kδ −
// cδ̇); the paper's f = −kδ − cδ̇, which may pull; Hunt–Crossley f = k|δ|ⁿ(1 − α δ̇). The line is infinite, or a face from ends[0] to
// ends[1] of the coordinate along t = (n_y, −n_x) from marker b. Source: theory.md §2.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/measure.h"

namespace steplap {

class SystemBuilder;

struct UnilateralContact : Element {
  std::string a, b = "ground";
  Vec2 normal{0.0, 1.0};           ///< normal of the line in marker b's axes, towards a
  std::optional<Vec2> axis;        ///< contact axis in marker a's axes; not given: the normal
  std::optional<double> stiffness; ///< k of one element
  double damping = 0.0;
  std::string material;                  ///< of a pad instead of the stiffness (pad.h)
  std::optional<double> area, thickness; ///< of a pad, m², m
  std::string law = "kelvin_voigt";
  std::optional<double> restitution;  ///< coefficient of restitution, replaces damping (restitution.h)
  double exponent = 1.0;              ///< exponent n of the Hunt–Crossley law
  double dissipation = 0.0;           ///< Hunt–Crossley α, s/m
  std::optional<double> preload;      ///< force in the reference pose, N
  std::optional<double> interference; ///< penetration −δ in the reference pose, m
  std::optional<double> gap;          ///< gap δ in the reference pose, m
  std::optional<Vec2> ends;           ///< coordinates of the ends along the face from marker b, m (ended_contact.h)
  long count = 1;
};

/// Returns the stiffness of all elements side by side, as given or of a pad, N/m (Hunt–Crossley: N/mⁿ).
[[nodiscard]] double stiffness_of(const UnilateralContact& contact);

/// Bodies and geometry of a contact, for friction elements that refer to it.
struct ContactGeometry {
  int a = k_ground, b = k_ground;
  GapMeasure gap;
};
[[nodiscard]] ContactGeometry contact_geometry(const UnilateralContact& contact, const SystemBuilder& builder);
/// Returns the total damping c, N s/m, of all parallel elements of the contact: as given, or from its restitution. Reports an error if that
/// is impossible.
[[nodiscard]] double damping_of(const UnilateralContact& contact, const ContactGeometry& geometry, SystemBuilder& builder);

[[nodiscard]] const ElementKind& unilateral_contact_kind();

} // namespace steplap
