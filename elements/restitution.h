// The damper of a Kelvin–Voigt contact that gives a coefficient of restitution.
//
// Two bodies of effective mass m that meet by a spring k and a damper c which never pulls part where the force has fallen to zero,
// with the share of the closing speed that Schwager and Pöschel (Granular Matter 9, 2007) found. With ζ = c/(2 √(k m)) it is
//   e = exp(−2ζ/√(1 − ζ²) · arccos ζ),   for ζ > 1: exp(−2ζ/√(ζ² − 1) · arcosh ζ),
// whatever the speed. Other forces during the blow, such as the weight, are left out: they count the less, the stiffer the contact.
//
// The effective mass is that of the two bodies alone in the reference pose, 1/(J M⁻¹ Jᵀ) with the gradient J of the gap (27). What
// else holds them, joints, welds and springs, does not count.
#pragma once

#include "mbd/system/row_gradient.h"
#include "mbd/system/system.h"

#include <limits>
#include <optional>

namespace steplap {

/// e, 0 to 1, of a contact with the damping ratio ζ ≥ 0.
[[nodiscard]] double restitution_of(double damping_ratio);
/// c, N s/m, for e in (0, 1]; `stiffness`: N/m; `mass`: kg, effective.
[[nodiscard]] double damping_for_restitution(double restitution, double stiffness, double mass);
/// kg (kg m² of a gap that is an angle); infinite where neither body can move along it.
[[nodiscard]] double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder);

/// c of a contact that closes along `measure`: as given, or by its restitution, of which an error is noted if no body can move.
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
