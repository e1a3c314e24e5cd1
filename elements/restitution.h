// Damping coefficient of a Kelvin–Voigt contact for a given coefficient of restitution.
//
// Two bodies of effective mass m collide with spring k and damper c, whose force cannot pull, and separate where the force becomes zero.
// The ratio of separation to approach speed (T. Schwager, T. Pöschel, Granular Matter 9, 2007) depends only on ζ = c/(2 √(k m)):
//
//   e = exp(−2ζ/√(1 − ζ²) · arccos ζ),   for ζ > 1: exp(−2ζ/√(ζ² − 1) · arcosh ζ).
//
// Other forces during the collision, such as weight, are neglected; their influence decreases with the stiffness of the contact. The
// effective mass is 1/(J P Jᵀ) in the reference pose, with the gradient J of the gap (27) and the inverse mass P under the joints and drives
// that act, P = M⁻¹ − M⁻¹Gᵀ(G M⁻¹Gᵀ)⁺G M⁻¹, where G has the gradients of their rows. A rod on a pin meets its stop with its inertia about
// the pin. Springs, friction and other contacts are not considered.
#pragma once

#include "mbd/system/row_gradient.h"
#include "mbd/system/system.h"

#include <cmath>
#include <limits>
#include <optional>

namespace steplap {

/// Returns e, 0 to 1, for the damping ratio ζ ≥ 0.
[[nodiscard]] double restitution_of(double damping_ratio);
/// Returns c, N s/m, for e in (0, 1]; `stiffness` in N/m, effective `mass` in kg.
[[nodiscard]] double damping_for_restitution(double restitution, double stiffness, double mass);
/// Returns the effective mass under the joints compiled so far, kg (kg m² if the gap is an angle); infinite if nothing can move along the
/// gap; NaN if too many joined bodies take part.
[[nodiscard]] double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder);

/// Damping of a contact or stop as given in a model.
struct GivenDamper {
  double damping = 0.0, stiffness = 0.0;
  std::optional<double> restitution = {}; ///< coefficient of restitution, given instead of `damping`
};

/// Returns c, N s/m, of a contact that closes along `measure`: as given, or from its restitution. Precondition: the rows of all joints are
/// compiled. Reports an error if no body can move along the measure.
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

/// Calls put(law, c) for the last entry of `group` once the joints are compiled, with the damping c from its restitution.
template <class Group, class Measure, class Put>
void set_damping_from_restitution(Group& group, const GivenDamper& given, int a, int b, const Measure& measure, SystemBuilder& builder,
                                  Put put) {
  if (!given.restitution) return;
  builder.after_joints([&group, i = group.entries.size() - 1, given, a, b, measure, &builder, put] {
    put(group.entries[i].law, contact_damping(given, a, b, measure, builder));
  });
}

} // namespace steplap
