// Contact and friction modes of the hand-written transformer: event functions, mode changes, and the choice between sticking and slip.

#include "transformer_kinematics.h"

namespace steplap::peers {

using namespace transformer;

double Transformer::effective_gap(int contact, const Kinematics& k, const double* y) const {
  return gap(contact, k, y) + (contact < 2 ? foot_offset_ : wood_offset_);
}

double Transformer::force_law(int contact, const Kinematics& k, const double* y) const {
  return -k_stiffness[contact] * effective_gap(contact, k, y) - k_damping[contact] * gap_rate(contact, k, y);
}

// Returns the velocity of the foot's tip along the floor, ṡ with s = rx + d tan φ + L sec φ, m/s.
double Transformer::slide_speed(const Kinematics& k) const {
  return k.rxd + k.ryd * k.tan + (k.d + k_place[foot_] * k.sp) * k.sec2 * k.phid;
}

void Transformer::kinematic_switches(const double* y, double* g) const {
  const Kinematics k = kinematics(y);
  for (int i = 0; i < k_contacts; ++i) {
    g[k_leave + i] = g[k_return + i] = k_unwatched;
    switch (contacts_[i]) {
    case ContactMode::closed: g[k_leave + i] = k_force_scale * force_law(i, k, y); break;
    case ContactMode::held:
      g[k_leave + i] = -k_length_scale * effective_gap(i, k, y);
      g[k_return + i] = -k_force_scale * force_law(i, k, y);
      break;
    case ContactMode::open: g[k_leave + i] = k_length_scale * effective_gap(i, k, y); break;
    }
  }
  g[k_friction_upper] = g[k_friction_lower] = k_unwatched;
  if (friction_ == FrictionMode::slip_forward) g[k_friction_upper] = k_speed_scale * slide_speed(k);
  else if (friction_ == FrictionMode::slip_backward) g[k_friction_upper] = -k_speed_scale * slide_speed(k);
  const double phi = y[2] - y[4];
  g[k_foot_switch] = k_length_scale * ((foot_ == 0 ? phi : -phi) + k_dead_band);
}

void Transformer::switches(double t, const double* y, double* g) {
  kinematic_switches(y, g);
  if (!sticking()) return;
  double unused[k_states];
  rates(t, y, unused);
  stick_switches(g);
}

void Transformer::stick_switches(double* g) const {
  if (!sticking()) return;
  g[k_friction_upper] = k_force_scale * (k_friction * normal_ - lambda_);
  g[k_friction_lower] = k_force_scale * (k_friction * normal_ + lambda_);
}

double Transformer::switch_value(int slot, double t, const double* y) {
  const bool needs_multiplier = sticking() && (slot == k_friction_upper || slot == k_friction_lower);
  if (needs_multiplier) {
    double unused[k_states];
    rates(t, y, unused);
    const double side = slot == k_friction_upper ? -lambda_ : lambda_;
    return k_force_scale * (k_friction * normal_ + side);
  }
  if (slot == k_foot_switch) {
    const double phi = y[2] - y[4];
    return k_length_scale * ((foot_ == 0 ? phi : -phi) + k_dead_band);
  }
  const Kinematics k = kinematics(y);
  if (slot == k_friction_upper) {
    const double speed = k_speed_scale * slide_speed(k);
    return friction_ == FrictionMode::slip_backward ? -speed : speed;
  }
  const int i = slot < k_return ? slot : slot - k_return;
  if (slot >= k_return) return -k_force_scale * force_law(i, k, y);
  if (contacts_[i] == ContactMode::closed) return k_force_scale * force_law(i, k, y);
  const double side = contacts_[i] == ContactMode::open ? k_length_scale : -k_length_scale;
  return side * effective_gap(i, k, y);
}

// Chooses stick if friction can hold the load, otherwise slip in the direction of the missing force.
void Transformer::try_stick(double t, State& y) {
  friction_ = FrictionMode::stick;
  State unused;
  rates(t, y.data(), unused.data());
  if (std::abs(lambda_) <= k_friction * normal_) return;
  friction_ = lambda_ > 0.0 ? FrictionMode::slip_backward : FrictionMode::slip_forward;
}

// Chooses the friction mode again after a jump of the contact forces or a change of the contact foot.
void Transformer::settle_friction(double t, State& y) {
  const bool touching = contacts_[0] == ContactMode::closed || contacts_[1] == ContactMode::closed;
  if (!touching) {
    friction_ = FrictionMode::none;
    return;
  }
  if (friction_ == FrictionMode::none) {
    const double speed = slide_speed(kinematics(y.data()));
    if (std::abs(speed) > k_still) friction_ = speed > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
    else try_stick(t, y);
  } else if (friction_ == FrictionMode::stick) {
    try_stick(t, y);
  }
}

void Transformer::cross(int slot, double t, State& y) {
  if (slot == k_foot_switch) {
    foot_ = 1 - foot_;
    settle_friction(t, y);
  } else if (slot == k_friction_upper && !sticking()) {
    // Sets ṡ exactly to zero, because rounding would cause a drift while sticking.
    const Kinematics k = kinematics(y.data());
    y[6] -= slide_speed(k) / (k.c - k.s * k.tan);
    try_stick(t, y);
  } else if (slot == k_friction_upper) {
    friction_ = FrictionMode::slip_backward; // friction pushes forward with λ = +μN
  } else if (slot == k_friction_lower) {
    friction_ = FrictionMode::slip_forward;
  } else if (slot >= k_return) {
    contacts_[slot - k_return] = ContactMode::closed;
    settle_friction(t, y);
  } else {
    ContactMode& mode = contacts_[slot];
    if (mode == ContactMode::closed) mode = ContactMode::held;
    else if (mode == ContactMode::held) mode = ContactMode::open;
    else mode = ContactMode::closed;
    settle_friction(t, y);
  }
}

const char* Transformer::describe(int slot) const {
  static constexpr const char* k_closed[] = {"rear foot unloaded", "front foot unloaded", "rear block unloaded", "front block unloaded"};
  static constexpr const char* k_held[] = {"rear foot lifts", "front foot lifts", "rear block lifts", "front block lifts"};
  static constexpr const char* k_open[] = {"rear foot lands", "front foot lands", "rear block lands", "front block lands"};
  static constexpr const char* k_back[] = {"rear foot loaded", "front foot loaded", "rear block loaded", "front block loaded"};
  if (slot == k_foot_switch) return "foot switch";
  if (slot >= k_friction_upper) return sticking() ? "slip" : "stick";
  if (slot >= k_return) return k_back[slot - k_return];
  if (contacts_[slot] == ContactMode::closed) return k_closed[slot];
  return contacts_[slot] == ContactMode::held ? k_held[slot] : k_open[slot];
}

} // namespace steplap::peers
