// Coulomb friction as a friction element: |λ| ≤ μ_s N while it sticks, μ_k N against the slip, N the sum of the normal forces
// of contacts. Which rows it sticks along, and where, is up to who makes one (coulomb_stick, polygon_contact).
#pragma once

#include "elements/bounded_friction.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

class CoulombFriction : public FrictionElement {
public:
  // Level feet are the normal state at rest: the foot is kept within this dead band, rad.
  static constexpr double k_foot_dead_band = 1e-13;
  // Acceleration beside which an error of friction counts, m/s²: that of the motion to which tolerances are absolute.
  static constexpr double k_floor_acceleration = 3.6;

  std::vector<ContactIndex> contacts;
  std::vector<RowSpec> feet; ///< rear-most, front-most; the same twice for one contact
  bool has_two_feet = false;
  double level = 0.0; ///< θ_A − θ_B at which both feet touch, rad
  double mu_static = 0.0, mu_kinetic = 0.0;
  bool may_pull = false;                         ///< a contact's law lets it pull (literal): friction ends where the sum does
  double damping = 0.0, mass = 0.0, lever = 0.0; ///< of the contacts; of the lighter body; from its centre

  [[nodiscard]] int dimension() const override { return 1; }
  [[nodiscard]] const RowSpec* rows(const FrictionState& state) const override { return &feet[state.foot]; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[feet[0].a] = is_used[feet[0].b] = 1; }
  template <class S> [[nodiscard]] S normal_force(const Evaluated<S>& e) const { return greatest_of(S(0.0), sum_of_forces(e)); }
  /// As laws of motion have it: a step that goes beyond the end of a contact's force, where it will be cut, finds the force's law
  /// go on below zero there. A kink at that place would make the step, and what is read inside it, as inexact as its end is known.
  /// Not so for friction above 1, which makes of a force that is below zero by rounding a larger one.
  template <class S> [[nodiscard]] S smooth_normal_force(const Evaluated<S>& e) const {
    return may_pull || mu_static > 1.0 ? normal_force(e) : sum_of_forces(e);
  }
  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState&) const override {
    return std::any_of(contacts.begin(), contacts.end(),
                       [&e](const ContactIndex& contact) { return e.mode[contact.unit] == k_contact_pressed; });
  }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = sliding_force(e, state);
  }
  [[nodiscard]] double support(const Evaluation& e, const FrictionState&, const double* rate) const override {
    return mu_static * normal_force(e) * std::abs(rate[0]);
  }
  void watch_stick(const Evaluation& e, const FrictionState&, const double* wrench, double* watch) const override {
    watch_bounds<double>(e, wrench, watch);
  }
  [[nodiscard]] bool trace_friction(TracedEvaluation& e, const FrictionState& state, const Traced* rate, Traced* wrench,
                                    Traced* watch) const override {
    if (rate) {
      wrench[0] = sliding_force(e, state);
      watch[0] = state.sign * rate[0];
      watch[1] = 1.0;
    } else {
      watch_bounds(e, wrench, watch);
    }
    watch[2] = turn_to_other_foot(e, state);
    return true;
  }
  void begin_slip(const Evaluation&, FrictionState& state, const double* wrench) const override { state.sign = wrench[0] > 0.0 ? -1 : 1; }
  [[nodiscard]] double watch_place(const Evaluation& e, const FrictionState& state) const override { return turn_to_other_foot(e, state); }
  void change_place(const Evaluation&, FrictionState& state) const override { state.foot = state.foot == 0 ? 1 : 0; }
  // The contacts' dampers make forces of errors of velocity, and friction with μ > 1 larger ones of these: against what
  // would accelerate the body as the motion does to which tolerances are absolute. Else the contact rattles: it would
  // lose and regain, by errors alone, a normal force so small that the tolerance does not show it and yet enough to
  // carry the body by its friction.
  [[nodiscard]] bool turns_with_slip(const FrictionState&) const override { return mu_kinetic > 1.0 && damping > 0.0; }
  [[nodiscard]] SlipScale slip_scale(const Evaluation&, const FrictionState&, const double*) const override {
    SlipScale scale;
    scale.lever = lever;
    if (mu_kinetic > 1.0 && damping > 0.0) scale.speed = k_floor_acceleration * mass / ((mu_kinetic - 1.0) * damping);
    return scale;
  }
  [[nodiscard]] FrictionBlock solve_block(const Evaluation& e, const FrictionState&, const double* a, const double* b,
                                          bool is_kinetic) const override {
    return block_within((is_kinetic ? mu_kinetic : mu_static) * normal_force(e), a[0], b[0]);
  }

private:
  template <class S> [[nodiscard]] S sum_of_forces(const Evaluated<S>& e) const {
    S sum{0.0};
    for (const ContactIndex& contact : contacts) sum += e.contact_force[contact.force];
    return sum;
  }
  template <class S> [[nodiscard]] S sliding_force(const Evaluated<S>& e, const FrictionState& state) const {
    return -mu_kinetic * smooth_normal_force(e) * state.sign;
  }
  template <class S> void watch_bounds(const Evaluated<S>& e, const S* wrench, S* watch) const {
    steplap::watch_bounds<S>(mu_static * smooth_normal_force(e), wrench[0], watch);
  }
  template <class S> [[nodiscard]] S turn_to_other_foot(const Evaluated<S>& e, const FrictionState& state) const {
    if (!has_two_feet) return 1.0;
    S turn = e.motion[feet[0].a].theta - e.motion[feet[0].b].theta;
    if (level != 0.0) turn = turn - S(level);
    return k_foot_dead_band + (state.foot == 0 ? turn : -turn);
  }
};

} // namespace steplap
