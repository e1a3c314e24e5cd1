// The damper of a Kelvin–Voigt contact that gives a coefficient of restitution.
//
// Two bodies of effective mass m that meet by a spring k and a damper c which never pulls part where the force has fallen to zero,
// with the share of the closing speed that Schwager and Pöschel (Granular Matter 9, 2007) found. With ζ = c/(2 √(k m)) it is
//   e = exp(−2ζ/√(1 − ζ²) · arccos ζ),   for ζ > 1: exp(−2ζ/√(ζ² − 1) · arcosh ζ),
// whatever the speed. Other forces during the blow, such as the weight, are left out: they count the less, the stiffer the contact.
//
// The effective mass is 1/(J P Jᵀ) in the reference pose, with the gradient J of the gap (27) and P the inverse mass under the joints and
// drives that act: P = M⁻¹ − M⁻¹Gᵀ(G M⁻¹Gᵀ)⁺G M⁻¹, G the gradients of their rows. A rod on a pin meets its stop with its inertia about
// the pin. Springs, friction and other contacts do not count.
#pragma once

#include "mbd/system/row_gradient.h"
#include "mbd/system/system.h"

#include <cmath>
#include <limits>
#include <optional>

namespace steplap {

/// e, 0 to 1, of a contact with the damping ratio ζ ≥ 0.
[[nodiscard]] double restitution_of(double damping_ratio);
/// c, N s/m, for e in (0, 1]; `stiffness`: N/m; `mass`: kg, effective.
[[nodiscard]] double damping_for_restitution(double restitution, double stiffness, double mass);
/// kg (kg m² of a gap that is an angle), under the joints compiled so far; infinite where nothing can move along the gap. Not a number
/// where more joined bodies take part than is worth its cost.
[[nodiscard]] double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder);

/// What a contact or stop says of its damper.
struct GivenDamper {
  double damping = 0.0, stiffness = 0.0;
  std::optional<double> restitution = {}; ///< instead of `damping`
};

/// c of a contact that closes along `measure`, when the rows of all joints are compiled: as given, or by its restitution. An error is
/// noted if no body can move.
template <class Measure>
[[nodiscard]] double contact_damping(const GivenDamper& given, int a, int b, const Measure& measure, SystemBuilder& builder) {
  if (!given.restitution) return given.damping;
  const auto at_reference = measure.template at<false, double>(builder.reference(a), builder.reference(b));
  const double mass = effective_mass(gradient_of(at_reference), a, b, builder);
  if (mass < std::numeric_limits<double>::infinity()) return damping_for_restitution(*given.restitution, given.stiffness, mass);
  builder.error(std::isnan(mass) ? "'restitution' of bodies among so many that joints connect is not computed: give 'damping'"
                                 : "'restitution' needs a mass: nothing can move along it in the reference pose");
  return 0.0;
}

/// Gives the law of the last entry of `group` its damper by restitution, once the joints are compiled: put(law, c).
template <class Group, class Measure, class Put>
void damp_after_joints(Group& group, const GivenDamper& given, int a, int b, const Measure& measure, SystemBuilder& builder, Put put) {
  if (!given.restitution) return;
  builder.after_joints([&group, i = group.entries.size() - 1, given, a, b, measure, &builder, put] {
    put(group.entries[i].law, contact_damping(given, a, b, measure, builder));
  });
}

} // namespace steplap
