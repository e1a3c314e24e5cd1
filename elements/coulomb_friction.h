// Coulomb friction as a friction element: |λ| ≤ μ_s N while sticking, μ_k N opposite to the slip, with N the sum of the normal forces of
// its contacts. The elements that use it (coulomb_stick, polygon_contact) define the rows and the contact points.
#pragma once

#include "mbd/system/bounded_friction.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

class CoulombFriction : public BoundedFriction {
public:
  // Dead band for the change between feet, rad. At rest the feet are normally level, so rounding would change the foot.
  static constexpr double k_foot_dead_band = 1e-13;
  // Acceleration, m/s², that an error of friction may cause: that of a motion at the velocities below which tolerances are absolute.
  static constexpr double k_floor_acceleration = 3.6;

  std::vector<ContactIndex> contacts;
  std::vector<RowSpec> feet;               ///< rows at the contact points; of several feet from the rear-most to the front-most
  std::vector<ContactIndex> foot_contacts; ///< contact of each foot if there are several, else empty
  std::vector<double> levels; ///< θ_A − θ_B at which both feet of a pair touch, rad; at index rear · number of feet + front
  double mu_static = 0.0, mu_kinetic = 0.0;
  bool may_pull = false; ///< a contact may pull (law `literal`); friction ends where the sum of normal forces becomes zero
  /// Damping of the contacts, N s/m; mass of the lighter body, kg; distance of the contact from its centre of gravity, m.
  double damping = 0.0, mass = 0.0, lever = 0.0;

  [[nodiscard]] const RowSpec* rows(const FrictionState& state) const override { return &feet[state.foot]; }
  void mark_bodies(std::vector<char>& is_used) const override { is_used[feet[0].a] = is_used[feet[0].b] = 1; }
  template <class S> [[nodiscard]] S normal_force(const EvaluationData<S>& e) const { return greatest_of(S(0.0), sum_of_forces(e)); }
  /// Returns N, continued to negative values like a force law: a step may extend slightly beyond the end of a contact force before this is
  /// detected, and a kink there would make the step as inaccurate as the time of its end. Not continued for friction above 1, which would
  /// amplify a force that is negative by rounding.
  template <class S> [[nodiscard]] S smooth_normal_force(const EvaluationData<S>& e) const {
    return may_pull || mu_static > 1.0 ? normal_force(e) : sum_of_forces(e);
  }
  [[nodiscard]] bool is_loaded(const Evaluation& e, const FrictionState&) const override {
    return mu_static != 0.0 && presses(e); // otherwise it holds nothing under any normal force
  }
  /// Returns the phase that the channel `mode` shows. Without friction, pressed bodies slip.
  [[nodiscard]] double shown_phase(const Evaluation& e, const FrictionState& state) const {
    return static_cast<double>(mu_static == 0.0 && presses(e) ? FrictionPhase::slip : state.phase);
  }
  void slip_wrench(const Evaluation& e, const FrictionState& state, const double*, double* wrench) const override {
    wrench[0] = sliding_force(e, state);
  }
  [[nodiscard]] WrenchBounds bounds(const Evaluation& e, const FrictionState&, bool kinetic) const override {
    return WrenchBounds::symmetric((kinetic ? mu_kinetic : mu_static) * normal_force(e));
  }
  void stick_events(const Evaluation& e, const FrictionState&, const double* wrench, double* event_value) const override {
    bound_events<double>(e, wrench, event_value);
  }
  [[nodiscard]] bool record_friction(TracedEvaluation& e, const FrictionState& state, const TapeNumber* rate, TapeNumber* wrench,
                                     TapeNumber* event_value) const override {
    if (rate) {
      wrench[0] = sliding_force(e, state);
      event_value[0] = state.sign * rate[0];
      event_value[1] = 1.0;
    } else {
      bound_events(e, wrench, event_value);
    }
    event_value[2] = turn_to_other_foot<TapeNumber>(e, state, closed_feet(e.mode));
    return true;
  }
  [[nodiscard]] double contact_point_event(const Evaluation& e, const FrictionState& state) const override {
    return turn_to_other_foot<double>(e, state, closed_feet(e.mode));
  }
  void switch_contact_point(const Evaluation& e, FrictionState& state) const override {
    if (foot_contacts.empty()) return;
    const ClosedFeet closed = closed_feet(e.mode);
    const bool was_rear = state.foot == closed.rear, was_front = state.foot == closed.front;
    // A foot at an end gives way to the other end, whatever the rounding of the angle; any other foot to the end that the angle chooses.
    const bool is_rear = was_rear != was_front ? was_front : turn_of<double>(e, closed) >= 0.0;
    state.foot = is_rear ? closed.rear : closed.front;
  }
  [[nodiscard]] bool is_foot_wrong(const Evaluation& e, const FrictionState& state) const override {
    return !foot_contacts.empty() && turn_to_other_foot<double>(e, state, closed_feet(e.mode)) < 0.0;
  }
  // The slip rates of two feet differ by the relative angular velocity times their difference in height along the normal of the line. Feet
  // on one line are level when the angle changes the foot, so slip rate and force are continuous; only the slip acceleration jumps, by the
  // distance of the feet times the square of the angular velocity. The integration is restarted there, but no event is reported. If the
  // foot changes because it opens, its contact reports that.
  [[nodiscard]] EventKind contact_switch_event(const FrictionState&, const FrictionState&) const override {
    // Tolerance of equal heights relative to the distance from the centre: rounding of coordinates in the file.
    constexpr double k_level_feet = 1e-12;
    const auto is_level = [this](const RowSpec& foot) {
      return std::abs(foot.direction.dot(foot.point_b - feet[0].point_b)) <= k_level_feet * lever;
    };
    return !foot_contacts.empty() && std::all_of(feet.begin(), feet.end(), is_level) ? EventKind::none : EventKind::changes_foot;
  }
  // A contact damper converts velocity errors to normal force errors, and friction with μ > 1 amplifies them. The required accuracy of
  // velocities therefore limits the resulting acceleration to k_floor_acceleration. Otherwise the contact chatters: errors alone remove and
  // restore a normal force below the tolerance, whose friction still moves the body.
  [[nodiscard]] bool depends_on_slip_direction(const FrictionState&) const override { return mu_kinetic > 1.0 && damping > 0.0; }
  [[nodiscard]] SlipScale slip_scale(const Evaluation&, const FrictionState&, const double*) const override {
    SlipScale scale;
    scale.lever = lever;
    if (mu_kinetic > 1.0 && damping > 0.0) scale.speed = k_floor_acceleration * mass / ((mu_kinetic - 1.0) * damping);
    return scale;
  }

private:
  [[nodiscard]] bool presses(const Evaluation& e) const {
    return std::any_of(contacts.begin(), contacts.end(),
                       [&e](const ContactIndex& contact) { return e.mode[contact.unit] == k_contact_pressed; });
  }
  template <class S> [[nodiscard]] S sum_of_forces(const EvaluationData<S>& e) const {
    S sum{0.0};
    for (const ContactIndex& contact : contacts) sum += e.contact_force[contact.force];
    return sum;
  }
  template <class S> [[nodiscard]] S sliding_force(const EvaluationData<S>& e, const FrictionState& state) const {
    return -mu_kinetic * smooth_normal_force(e) * state.sign;
  }
  template <class S> void bound_events(const EvaluationData<S>& e, const S* wrench, S* event_value) const {
    steplap::bound_events<S>(mu_static * smooth_normal_force(e), wrench[0], event_value);
  }
  // The rear-most and the front-most of the feet that are closed; of all feet if none is. A foot that is closed without force still counts:
  // it is within the depth of the others, and is left at the angle at which both move alike.
  struct ClosedFeet {
    std::uint32_t rear = 0, front = 0;
  };
  [[nodiscard]] ClosedFeet closed_feet(const UnitMode* mode) const {
    const auto count = static_cast<std::uint32_t>(foot_contacts.size());
    const auto is_closed = [&](std::uint32_t foot) {
      const UnitMode now = mode[foot_contacts[foot].unit];
      return now == k_contact_pressed || now == k_contact_released;
    };
    ClosedFeet closed{0, count > 0 ? count - 1 : 0};
    while (closed.rear < count && !is_closed(closed.rear)) ++closed.rear;
    if (closed.rear >= count) return {0, closed.front};
    while (!is_closed(closed.front)) --closed.front;
    return closed;
  }
  // Returns by how much a is turned from the angle at which both feet touch, rad: the friction is at the rear foot while this is positive.
  template <class S> [[nodiscard]] S turn_of(const EvaluationData<S>& e, const ClosedFeet& closed) const {
    const S turn = e.motion[feet[0].a].theta - e.motion[feet[0].b].theta;
    const double level = levels[closed.rear * feet.size() + closed.front];
    return level != 0.0 ? turn - S(level) : turn;
  }
  template <class S>
  [[nodiscard]] S turn_to_other_foot(const EvaluationData<S>& e, const FrictionState& state, const ClosedFeet& closed) const {
    if (foot_contacts.empty()) return S(1.0);
    if (state.foot != closed.rear && state.foot != closed.front) return S(-1.0);
    if (closed.rear == closed.front) return S(1.0);
    const S turn = turn_of(e, closed);
    return k_foot_dead_band + (state.foot == closed.rear ? turn : -turn);
  }
};

} // namespace steplap
