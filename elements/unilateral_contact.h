// Unilateral contact: a marker on a against a line on b (feet plates, wooden blocks; the H(−δ) terms of
// Eqs. (2), (4)).
//
// Gap δ = n·(p_A − p_B)/(n·a) − offset, closed when δ < 0; the force n/(n·a) acts at the tip p_A − δ a.
// The contact axis a is the normal itself, or fixed in body a (a shaft whose tip rests on b's line: the
// foot of Eq. 8). Laws: Kelvin–Voigt without adhesion f = max(0, −kδ − cδ̇); the paper's literal
// f = −kδ − cδ̇, which may pull; Hunt–Crossley f = k|δ|ⁿ(1 − α δ̇). Source: physics.md §2.
// The line is endless, or a face from ends[0] to ends[1] of the coordinate along t = (n_y, −n_x) from marker b.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/measure.h"

namespace steplap {

class SystemBuilder;

struct UnilateralContact : Element {
  std::string a, b = "ground";
  Vec2 normal{0.0, 1.0};    ///< of the line, in marker b's axes, pointing at a
  std::optional<Vec2> axis; ///< contact axis in marker a's axes
  double stiffness = 0.0, damping = 0.0;
  std::string law = "kelvin_voigt";
  std::optional<double> restitution;  ///< instead of damping (restitution.h)
  double exponent = 1.0;              ///< Hunt–Crossley n
  double dissipation = 0.0;           ///< Hunt–Crossley α
  std::optional<double> preload;      ///< force in the reference pose
  std::optional<double> interference; ///< −δ in the reference pose
  std::optional<double> gap;          ///< δ in the reference pose
  std::optional<Vec2> ends;           ///< where the face ends, along it from marker b (ended_contact.h)
  long count = 1;
};

/// Bodies and geometry of a contact, for the friction that sits on it.
struct ContactGeometry {
  int a = k_ground, b = k_ground;
  GapMeasure gap;
};
[[nodiscard]] ContactGeometry contact_geometry(const UnilateralContact& contact, const SystemBuilder& builder);
/// c, N s/m, of all its elements: as given, or by its restitution, of which an error is noted if it cannot be.
[[nodiscard]] double damping_of(const UnilateralContact& contact, const ContactGeometry& geometry, SystemBuilder& builder);

[[nodiscard]] const ElementKind& unilateral_contact_kind();

} // namespace steplap
