// Bearing: a journal in an elastic bearing, with dry friction that follows the reaction R. It sticks exactly while the couple is within
// μ_s r R, with the radius r of the journal, and slides against μ_k r R (Coulomb).
//
//   R = |F|,  F = −k d − c ḋ,  d the displacement of the journal from the bearing's centre, in the axes of b
//
// The friction rows of the kernel have bounds that depend on the state (FrictionElement), and R of a rigid pin is a multiplier. So the bearing
// has a stiffness, as real ones have. μ is that of bearing tables, couple over R r; of a dry journal with the coefficient μ₀ of its faces it
// is μ₀/√(1 + μ₀²), since R is then the resultant of normal force and friction.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Bearing : Element {
  std::string a, b = "ground";
  double stiffness = 0.0, damping = 0.0;  ///< N/m and N s/m, the same in all directions
  double radius = 0.0;                    ///< of the journal, m
  double static_friction = 0.0;           ///< μ_s
  std::optional<double> kinetic_friction; ///< μ_k; default: μ_s
  std::string source;                     ///< origin of the coefficients; results name it where they are unusual
};

[[nodiscard]] const ElementKind& bearing_kind();

} // namespace steplap
