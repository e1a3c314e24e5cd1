// Friction elements with one row. Their sets K of admissible forces are intervals, which bounds() returns; the mode problem, the support
// function and the gauge follow from the interval.
//
//   Coulomb friction          [−μN, μN]
//   one-way clutch            [−holds, drags] or [−drags, holds]; −∞ or ∞ if 'holds' is not given
//   inextensible rope         (−∞, 0]
#pragma once

#include "mbd/system/roles.h"

#include <algorithm>
#include <cmath>

namespace steplap {

// Relative tolerance of a bound, for rounding errors of the force on it. Loads are resolved to 1e-12, ten times this.
inline constexpr double k_friction_bound_slack = 1e-13;

/// Sets the event functions of sticking for a symmetric bound (FrictionElement::stick_events()) to bound ± λ, N or N m.
template <class S> void bound_events(const S& bound, const S& wrench, S* event_value) {
  const S most = bound * (1.0 + k_friction_bound_slack);
  event_value[0] = most - wrench;
  event_value[1] = most + wrench;
}

/// The set K of a one-dimensional friction element: low ≤ w ≤ high, with low ≤ 0 ≤ high. N or N m.
struct WrenchBounds {
  double low = 0.0, high = 0.0;
  double rounding = 0.0; ///< a wrench that exceeds a bound by no more than this is within it

  static WrenchBounds symmetric(double bound) { return {-bound, bound}; }
};

/// Friction along one row, with an interval K.
class BoundedFriction : public FrictionElement {
public:
  /// Returns K with the static coefficients, or with the kinetic ones if `kinetic`.
  [[nodiscard]] virtual WrenchBounds bounds(const Evaluation& e, const FrictionState& state, bool kinetic) const = 0;
  /// Returns true if a contact that has opened or closed makes another contact point right: the event function `contact_point` is negative
  /// then without having crossed zero.
  [[nodiscard]] virtual bool is_foot_wrong(const Evaluation& /*e*/, const FrictionState& /*state*/) const { return false; }

  [[nodiscard]] int dimension() const final { return 1; }
  [[nodiscard]] double support(const Evaluation& e, const FrictionState& state, const double* rate) const override {
    const WrenchBounds k = bounds(e, state, false);
    return (rate[0] > 0.0 ? -k.low : k.high) * std::abs(rate[0]);
  }
  /// Precondition: the bound on the side of `wrench` is not zero.
  [[nodiscard]] double gauge(const Evaluation& e, const FrictionState& state, const double* wrench, double* normal) const override {
    const WrenchBounds k = bounds(e, state, false);
    normal[0] = 1.0 / (wrench[0] < 0.0 ? k.low : k.high);
    return normal[0] * wrench[0];
  }
  void set_onset_direction(const Evaluation&, FrictionState& state, const double* wrench) const override {
    state.sign = wrench[0] > 0.0 ? -1 : 1;
  }
  void aim(FrictionState& state, const double* rate) const override { state.sign = rate[0] > 0.0 ? 1 : -1; }
  /// The first event function is σν, which becomes negative when the slip stops or reverses.
  void slip_events(const Evaluation&, const FrictionState& state, const double* rate, double* event_value) const override {
    event_value[0] = state.sign * rate[0];
    event_value[1] = 1.0;
  }
  [[nodiscard]] BlockSolution solve_block(const Evaluation& e, const FrictionState& state, const double* a, const double* b,
                                          bool kinetic) const override {
    constexpr double k_no_motion = 1e-12; // m/s or m/s²: rounding error of a coordinate that a drive keeps at rest
    const WrenchBounds k = bounds(e, state, kinetic);
    const double least = k.low * (1.0 + k_friction_bound_slack) - k.rounding, most = k.high * (1.0 + k_friction_bound_slack) + k.rounding;
    BlockSolution block;
    const double wanted = a[0] > 0.0 ? -b[0] / a[0] : (b[0] > 0.0 ? k.low : k.high);
    // If a drive prescribes the coordinate (a = 0), friction cannot change the motion: the element sticks if the prescribed acceleration b
    // is zero.
    block.sticks = a[0] > 0.0 ? wanted >= least && wanted <= most : std::abs(b[0]) <= k_no_motion;
    block.wrench[0] = std::clamp(wanted, k.low, k.high);
    block.direction[0] = wanted > 0.5 * (k.low + k.high) ? -1.0 : 1.0;
    return block;
  }
};

} // namespace steplap
