// Damping coefficient of a Kelvin–Voigt contact for a given coefficient of restitution.
//
// Two bodies of effective mass m collide with spring k and damper c, whose force cannot pull, and separate where the force becomes zero.
// The ratio of separation to approach speed (T. Schwager, T. Pöschel, Granular Matter 9, 2007) depends only on ζ = c/(2 √(k m)):
//
//   e = exp(−2ζ/√(1 − ζ²) · arccos ζ),   for ζ > 1: exp(−2ζ/√(ζ² − 1) · arcosh ζ).
//
// Other forces during the collision, such as weight, are neglected; their influence decreases with the stiffness of the contact. The
// effective mass is that of the two bodies alone in the reference pose, 1/(J M⁻¹ Jᵀ) with the gradient J of the gap (27). Joints, welds and
// springs that hold the bodies are not considered.
#pragma once

#include "mbd/system/row_gradient.h"
#include "mbd/system/system.h"

#include <limits>
#include <optional>

namespace steplap {

/// Returns e, 0 to 1, for the damping ratio ζ ≥ 0.
[[nodiscard]] double restitution_of(double damping_ratio);
/// Returns c, N s/m, for e in (0, 1]; `stiffness` in N/m, effective `mass` in kg.
[[nodiscard]] double damping_for_restitution(double restitution, double stiffness, double mass);
/// Returns the effective mass, kg (kg m² if the gap is an angle); infinite if neither body can move along it.
[[nodiscard]] double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder);

/// Returns c of a contact that closes along `measure`: as given, or from its restitution. Reports an error if neither body can move along
/// it.
template <class Measure>
[[nodiscard]] double contact_damping(double damping, const std::optional<double>& restitution, double stiffness, int a, int b,
                                     const Measure& measure, SystemBuilder& builder) {
  if (!restitution) return damping;
  const auto at_reference = measure.template at<false, double>(builder.reference(a), builder.reference(b));
  const double mass = effective_mass(gradient_of(at_reference), a, b, builder);
  if (mass < std::numeric_limits<double>::infinity()) return damping_for_restitution(*restitution, stiffness, mass);
  builder.error("'restitution' needs a mass: neither of its bodies can move along it in the reference pose");
  return 0.0;
}

} // namespace steplap
