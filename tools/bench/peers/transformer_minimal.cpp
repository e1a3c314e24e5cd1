#include "transformer_minimal.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::peers {
namespace {

constexpr double k_gravity = 9.81;

// Bodies 1 + 2 + 3 as one: both limbs 1.25 m beside the common centre of gravity.
constexpr double k_mass_limb = 9000.0;
constexpr double k_inertia_limb = 6500.0;
constexpr double k_limb_x = 1.25;
constexpr double k_mass_active = 47000.0 + 2.0 * k_mass_limb;
constexpr double k_inertia_active =
    65200.0 + 2.0 * (k_inertia_limb + k_mass_limb * k_limb_x * k_limb_x);
constexpr double k_inv_mass = 1.0 / k_mass_active;
constexpr double k_inv_inertia = 1.0 / k_inertia_active;
constexpr double k_mass_upper = 20000.0;
constexpr double k_inertia_upper = 28000.0;
constexpr double k_mass_lower = 34600.0;
constexpr double k_inertia_lower = 55000.0;

constexpr double k_height_active = 1.95;                   // centre of gravity over the floor
constexpr double k_height_lower = 0.79;                    // of body 5
constexpr double k_rise_upper = 3.20 - k_height_lower;     // of body 4 over body 5
constexpr double k_cover = 3.90 - k_height_lower;          // wooden blocks over body 5
constexpr double k_block_plane = 3.90 - k_height_active;   // top line of body 1 over its centre
constexpr double k_top_arrest = 3.30 - k_height_active;    // height over the centre of body 1
constexpr double k_bottom_arrest = 0.30 - k_height_active; // (negative: below)
constexpr double k_suspension_drop = -0.50 - k_height_lower;

constexpr double k_foot_stiffness = 1.6e9, k_foot_damping = 1.5e5;
constexpr double k_wood_stiffness = 2e8, k_wood_damping = 5e4;
constexpr double k_top_stiffness = 2e8, k_top_damping = 2e5; // the pair
constexpr double k_bottom_stiffness = 2e8, k_bottom_damping = 4e4;
constexpr double k_tank_stiffness = 4e7, k_tank_damping = 4e4;
constexpr double k_suspension_stiffness = 2e8, k_suspension_damping = 1.5e6; // one of two
constexpr double k_suspension_arm = 1.5;
constexpr double k_friction = 0.35;

constexpr double k_place[k_contacts] = {-1.0, 1.0, -1.2, 1.2};
constexpr double k_stiffness[k_contacts] = {k_foot_stiffness, k_foot_stiffness, k_wood_stiffness,
                                            k_wood_stiffness};
constexpr double k_damping[k_contacts] = {k_foot_damping, k_foot_damping, k_wood_damping,
                                          k_wood_damping};

constexpr double k_interference_force = 98100.0; // both blocks
constexpr double k_wood_clearance = 0.5e-3;

constexpr double k_speed = 1.1 / 3.6;
constexpr double k_peak = 5.886;
constexpr double k_pulse_start = 0.05;
constexpr double k_pulse_length = 0.1;
constexpr double k_omega = 2.0 * std::numbers::pi / k_pulse_length;

constexpr double k_dead_band = 1e-13; // rad, of the foot switch: rounding at rest is no tilt
constexpr double k_still = 1e-12;     // m/s, slower than this counts as not sliding

constexpr double k_force_scale = 1e-5, k_length_scale = 1e3, k_speed_scale = 10.0;

struct Turn {
  double sine, cosine, versine; // versine: cos − 1
};

// The angles of this scene are milliradians: short series are exact to rounding,
// and unlike divisions they can be evaluated side by side.
constexpr double k_small = 0.01;

inline Turn turn(double x) {
  if (std::abs(x) > k_small) [[unlikely]]
    return {std::sin(x), std::cos(x), std::cos(x) - 1.0};
  const double z = x * x;
  const double versine = z * (-0.5 + z * (1.0 / 24.0 - z * (1.0 / 720.0)));
  return {x + x * z * (-1.0 / 6.0 + z * (1.0 / 120.0)), 1.0 + versine, versine};
}

struct Ratios {
  double secant, tangent;
};

inline Ratios ratios(double x, const Turn& of_x) {
  if (std::abs(x) > k_small) [[unlikely]]
    return {1.0 / of_x.cosine, of_x.sine / of_x.cosine};
  const double z = x * x;
  return {1.0 + z * (0.5 + z * (5.0 / 24.0 + z * (61.0 / 720.0))),
          x + x * z * (1.0 / 3.0 + z * (2.0 / 15.0 + z * (17.0 / 315.0)))};
}

double braking(double t) {
  const double s = t - k_pulse_start;
  if (s <= 0.0 || s >= k_pulse_length) return 0.0;
  return -0.5 * k_peak * (1.0 - std::cos(k_omega * s));
}

// x5(t), the braking integrated twice.
double travel(double t) {
  double x = k_speed * t;
  const double s = t - k_pulse_start;
  if (s <= 0.0) return x;
  const double in = std::min(s, k_pulse_length);
  x -= 0.5 * k_peak * (0.5 * in * in + (std::cos(k_omega * in) - 1.0) / (k_omega * k_omega));
  return x - 0.5 * k_peak * k_pulse_length * (s - in);
}

} // namespace

// Pose and velocity of body 1 seen from body 5, in the axes of body 5:
// (rx, ry) from the centre of 5 to that of 1, phi = θ1 − θ5.
struct Transformer::Kinematics {
  double c, s, versine;          // of θ5
  double cp, sp, sec, tan, sec2; // of phi
  double rx, ry, rxd, ryd, phid;
  double ut, un; // relative velocity of the centres along and across the floor
  double d;      // height of the centre of 1 over the floor line
};

inline Transformer::Kinematics Transformer::kinematics(const double* y) {
  Kinematics k;
  const Turn five = turn(y[4]);
  const Turn phi = turn(y[2] - y[4]);
  const Ratios of_phi = ratios(y[2] - y[4], phi);
  const double height = y[1] - y[3];
  const double u = y[6];
  const double v = y[7] - y[9];
  k.c = five.cosine;
  k.s = five.sine;
  k.versine = five.versine;
  k.cp = phi.cosine;
  k.sp = phi.sine;
  k.sec = of_phi.secant;
  k.tan = of_phi.tangent;
  k.sec2 = k.sec * k.sec;
  k.rx = k.c * y[0] + k.s * height;
  k.ry = k.c * height - k.s * y[0];
  k.ut = k.c * u + k.s * v;
  k.un = k.c * v - k.s * u;
  k.rxd = k.ut + y[10] * k.ry;
  k.ryd = k.un - y[10] * k.rx;
  k.phid = y[8] - y[10];
  k.d = k.ry + k_height_lower;
  return k;
}

Transformer::Transformer(Condition condition) {
  const bool tight = condition == Condition::interference;
  const double block = tight ? 0.5 * k_interference_force : 0.0;
  const double foot = 0.5 * k_mass_active * k_gravity + block;
  foot_offset_ = -foot / k_foot_stiffness;
  wood_offset_ = tight ? -block / k_wood_stiffness : k_wood_clearance;
  contacts_ = {ContactMode::closed, ContactMode::closed, ContactMode::closed, ContactMode::closed};
  if (!tight) contacts_[2] = contacts_[3] = ContactMode::open;
}

State Transformer::initial_state() const {
  State y{};
  y[1] = k_height_active;
  y[3] = k_height_lower;
  return y;
}

// Gap of a contact without preload. Feet: δ = n·(p_A − p_B)/(n·a) with a the y
// axis of body 1. Blocks: marker of the cover over the top line of body 1, a = n.
double Transformer::gap(int contact, const Kinematics& k, const double* y) {
  const double place = k_place[contact];
  if (contact < 2) return k.d * k.sec + place * k.tan - k_height_active;
  return -k.sp * (y[5] + place - k.rx) + k.cp * (k_cover - k.ry) - k_block_plane;
}

double Transformer::effective_gap(int contact, const Kinematics& k, const double* y) const {
  return gap(contact, k, y) + (contact < 2 ? foot_offset_ : wood_offset_);
}

double Transformer::gap_rate(int contact, const Kinematics& k, const double* y) {
  const double place = k_place[contact];
  if (contact < 2) return k.ryd * k.sec + (k.d * k.sec * k.tan + place * k.sec2) * k.phid;
  const double lever = -k.cp * (y[5] + place - k.rx) - k.sp * (k_cover - k.ry);
  return k.sp * (k.rxd - y[11]) - k.cp * k.ryd + lever * k.phid;
}

double Transformer::force_law(int contact, const Kinematics& k, const double* y) const {
  return -k_stiffness[contact] * effective_gap(contact, k, y) -
         k_damping[contact] * gap_rate(contact, k, y);
}

// Rate of s = rx + d tan φ + L sec φ, the tip's place along the floor.
double Transformer::slide_speed(const Kinematics& k) const {
  return k.rxd + k.ryd * k.tan + (k.d + k_place[foot_] * k.sp) * k.sec2 * k.phid;
}

void Transformer::rates(double t, const double* y, double* dydt) {
  ++evaluations_;
  const Kinematics k = kinematics(y);
  const double w = y[10];
  const double s4 = y[5];
  const double s4d = y[11];

  // Forces conjugate to rx, ry, φ and s4.
  double px = 0.0, py = 0.0, pphi = 0.0, ps = 0.0;
  normal_ = 0.0;
  const double foot_height = k.d * k.sec + (foot_offset_ - k_height_active);
  const double foot_lever = k.d * k.sec * k.tan;
  const double foot_rate = k.ryd * k.sec + foot_lever * k.phid;
  const bool rear = contacts_[0] == ContactMode::closed;
  const bool front = contacts_[1] == ContactMode::closed;
  if (rear || front) {
    // δ = height ± tan φ, its rate = foot_rate ± φ̇ sec² φ: half of both and their difference
    const double mean = -k_foot_stiffness * foot_height - k_foot_damping * foot_rate;
    const double tilt = -k_foot_stiffness * k.tan - k_foot_damping * k.sec2 * k.phid;
    const double f_rear = rear ? mean - tilt : 0.0;
    const double f_front = front ? mean + tilt : 0.0;
    normal_ = f_rear + f_front;
    py = normal_ * k.sec;
    pphi = normal_ * foot_lever + (f_front - f_rear) * k.sec2;
  }
  for (int i = 2; i < 4; ++i) {
    if (contacts_[i] != ContactMode::closed) continue;
    const double ux = s4 + k_place[i] - k.rx;
    const double uy = k_cover - k.ry;
    const double lever = -k.cp * ux - k.sp * uy;
    const double delta = -k.sp * ux + k.cp * uy + (wood_offset_ - k_block_plane);
    const double rate = k.sp * (k.rxd - s4d) - k.cp * k.ryd + lever * k.phid;
    const double f = -k_wood_stiffness * delta - k_wood_damping * rate;
    px += f * k.sp;
    py -= f * k.cp;
    pphi += f * lever;
    ps -= f * k.sp;
  }
  const double top = -k_top_stiffness * (k.rx - k_top_arrest * k.sp - s4) -
                     k_top_damping * (k.rxd - k_top_arrest * k.cp * k.phid - s4d);
  const double bottom = -k_bottom_stiffness * (k.rx - k_bottom_arrest * k.sp) -
                        k_bottom_damping * (k.rxd - k_bottom_arrest * k.cp * k.phid);
  px += top + bottom;
  pphi -= (k_top_arrest * top + k_bottom_arrest * bottom) * k.cp;
  ps -= top + k_tank_stiffness * s4 + k_tank_damping * s4d;

  const double s_phi = (k.d + k_place[foot_] * k.sp) * k.sec2; // ∂s/∂φ
  if (friction_ == FrictionMode::slip_forward || friction_ == FrictionMode::slip_backward) {
    const double force =
        friction_ == FrictionMode::slip_forward ? -k_friction * normal_ : k_friction * normal_;
    px += force;
    py += force * k.tan;
    pphi += force * s_phi;
  }

  // Generalised forces on the ground-fixed coordinates; inertia of the prescribed
  // x5 and velocity terms of body 4 on the right.
  const double a5 = braking(t);
  const double fx = k.c * px - k.s * py;
  const double fy = k.s * px + k.c * py;
  const double heave = y[3] - k_height_lower + k_suspension_drop * k.versine;
  const double heave_rate = y[9] - k_suspension_drop * k.s * w;
  const double lift = (k_mass_active + k_mass_upper + k_mass_lower) * k_gravity -
                      2.0 * (k_suspension_stiffness * heave + k_suspension_damping * heave_rate);
  const double righting = 2.0 * k_suspension_arm * k_suspension_arm *
                          (k_suspension_stiffness * k.s + k_suspension_damping * k.c * w);
  const double bx = -w * w * s4;
  const double by = w * (2.0 * s4d - w * k_rise_upper);
  const double q_y =
      lift - fy - (k_mass_upper + k_mass_lower) * k_gravity - k_mass_upper * (k.s * bx + k.c * by);
  const double q_theta =
      px * k.ry - py * k.rx - pphi - k_suspension_drop * k.s * lift - k.c * righting -
      k_mass_upper * k_gravity * (k.c * s4 - k.s * k_rise_upper) -
      2.0 * k_mass_upper * s4 * w * s4d + k_mass_upper * (k.s * s4 + k.c * k_rise_upper) * a5;
  const double q_s = ps - k_mass_upper * (k_gravity * k.s + bx + k.c * a5);

  // Active part: diagonal. Tank: s4 eliminated, two by two left.
  const double m11 = k_mass_lower + k_mass_upper * k.c * k.c;
  const double m12 = k_mass_upper * k.c * s4;
  const double m22 = k_inertia_lower + k_inertia_upper + k_mass_upper * s4 * s4;
  const double inv_det = 1.0 / (m11 * m22 - m12 * m12);
  const double r1 = q_y - k.s * q_s;
  const double r2 = q_theta + k_rise_upper * q_s;
  double ax = fx * k_inv_mass - a5;
  double ay = fy * k_inv_mass - k_gravity;
  double at = pphi * k_inv_inertia;
  double ay5 = (m22 * r1 - m12 * r2) * inv_det;
  double at5 = (m11 * r2 - m12 * r1) * inv_det;
  double as4 = q_s * (1.0 / k_mass_upper) - k.s * ay5 + k_rise_upper * at5;

  if (friction_ == FrictionMode::stick) { // J a = γ, λ from J M⁻¹ Jᵀ λ = γ − J a_f
    const double jx = k.c - k.s * k.tan;
    const double jy = k.s + k.c * k.tan;
    const double j5 = k.ry - k.tan * k.rx - s_phi;
    const double bias = w * (2.0 * k.un - w * k.rx) - w * (2.0 * k.ut + w * k.ry) * k.tan +
                        k.sec2 * k.phid *
                            (2.0 * k.ryd + 2.0 * k.d * k.tan * k.phid +
                             k_place[foot_] * k.sec * (1.0 + k.sp * k.sp) * k.phid);
    const double u1 = -m22 * jy - m12 * j5; // M⁻¹ Jᵀ of the tank, times the determinant
    const double u2 = m11 * j5 + m12 * jy;
    const double mobility =
        k.sec2 * k_inv_mass + s_phi * s_phi * k_inv_inertia + (j5 * u2 - jy * u1) * inv_det;
    const double inv_mobility = 1.0 / mobility;
    lambda_ = -(bias + jx * ax + jy * (ay - ay5) + s_phi * at + j5 * at5) * inv_mobility;
    const double by_det = lambda_ * inv_det;
    ax += jx * (lambda_ * k_inv_mass);
    ay += jy * (lambda_ * k_inv_mass);
    at += s_phi * (lambda_ * k_inv_inertia);
    ay5 += u1 * by_det;
    at5 += u2 * by_det;
    as4 += (k_rise_upper * u2 - k.s * u1) * by_det;
    stick_margin_ = std::min(stick_margin_, k_friction * normal_ - std::abs(lambda_));
  }
  std::copy(y + 6, y + 12, dydt);
  dydt[6] = ax;
  dydt[7] = ay;
  dydt[8] = at;
  dydt[9] = ay5;
  dydt[10] = at5;
  dydt[11] = as4;
}

void Transformer::kinematic_switches(const double* y, double* g) const {
  const Kinematics k = kinematics(y);
  for (int i = 0; i < k_contacts; ++i) {
    g[k_leave + i] = g[k_return + i] = k_unwatched;
    switch (contacts_[i]) {
    case ContactMode::closed:
      g[k_leave + i] = k_force_scale * force_law(i, k, y);
      break;
    case ContactMode::held:
      g[k_leave + i] = -k_length_scale * effective_gap(i, k, y);
      g[k_return + i] = -k_force_scale * force_law(i, k, y);
      break;
    case ContactMode::open:
      g[k_leave + i] = k_length_scale * effective_gap(i, k, y);
      break;
    }
  }
  g[k_friction_upper] = g[k_friction_lower] = k_unwatched;
  if (friction_ == FrictionMode::slip_forward)
    g[k_friction_upper] = k_speed_scale * slide_speed(k);
  else if (friction_ == FrictionMode::slip_backward)
    g[k_friction_upper] = -k_speed_scale * slide_speed(k);
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
  const bool needs_multiplier =
      sticking() && (slot == k_friction_upper || slot == k_friction_lower);
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

// Stick if friction can hold it, else slip the way the missing force leaves open.
void Transformer::try_stick(double t, State& y) {
  friction_ = FrictionMode::stick;
  State unused;
  rates(t, y.data(), unused.data());
  if (std::abs(lambda_) <= k_friction * normal_) return;
  friction_ = lambda_ > 0.0 ? FrictionMode::slip_backward : FrictionMode::slip_forward;
}

// Decides friction anew after the contact forces have jumped or a foot has switched.
void Transformer::settle_friction(double t, State& y) {
  const bool touching = contacts_[0] == ContactMode::closed || contacts_[1] == ContactMode::closed;
  if (!touching) {
    friction_ = FrictionMode::none;
    return;
  }
  if (friction_ == FrictionMode::none) {
    const double speed = slide_speed(kinematics(y.data()));
    if (std::abs(speed) > k_still)
      friction_ = speed > 0.0 ? FrictionMode::slip_forward : FrictionMode::slip_backward;
    else
      try_stick(t, y);
  } else if (friction_ == FrictionMode::stick) {
    try_stick(t, y);
  }
}

void Transformer::cross(int slot, double t, State& y) {
  if (slot == k_foot_switch) {
    foot_ = 1 - foot_;
    settle_friction(t, y);
  } else if (slot == k_friction_upper && !sticking()) {
    // Make s rest exactly, so that sticking starts without a creep of rounding.
    const Kinematics k = kinematics(y.data());
    y[6] -= slide_speed(k) / (k.c - k.s * k.tan);
    try_stick(t, y);
  } else if (slot == k_friction_upper) {
    friction_ = FrictionMode::slip_backward; // λ = +μN pushes forward
  } else if (slot == k_friction_lower) {
    friction_ = FrictionMode::slip_forward;
  } else if (slot >= k_return) {
    contacts_[slot - k_return] = ContactMode::closed;
    settle_friction(t, y);
  } else {
    ContactMode& mode = contacts_[slot];
    if (mode == ContactMode::closed)
      mode = ContactMode::held;
    else if (mode == ContactMode::held)
      mode = ContactMode::open;
    else
      mode = ContactMode::closed;
    settle_friction(t, y);
  }
}

double Transformer::bottom_arrest(const double* y) {
  const Kinematics k = kinematics(y);
  return -k_bottom_stiffness * (k.rx - k_bottom_arrest * k.sp) -
         k_bottom_damping * (k.rxd - k_bottom_arrest * k.cp * k.phid);
}

Outputs Transformer::outputs(double t, const State& y) {
  State a;
  rates(t, y.data(), a.data());
  const Kinematics k = kinematics(y.data());
  double contact[k_contacts];
  for (int i = 0; i < k_contacts; ++i)
    contact[i] = contacts_[i] == ContactMode::closed ? force_law(i, k, y.data()) : 0.0;
  Outputs o{};
  o.x1 = y[0] + travel(t);
  o.y1 = y[1];
  o.theta1 = y[2];
  o.y5 = y[3];
  o.theta5 = y[4];
  o.s4 = y[5];
  o.normal = normal_;
  o.friction = friction_ == FrictionMode::stick          ? lambda_
               : friction_ == FrictionMode::slip_forward ? -k_friction * normal_
               : friction_ == FrictionMode::none         ? 0.0
                                                         : k_friction * normal_;
  o.foot_rear = contact[0];
  o.foot_front = contact[1];
  o.wood_rear = contact[2];
  o.wood_front = contact[3];
  o.top_arrest = -k_top_stiffness * (k.rx - k_top_arrest * k.sp - y[5]) -
                 k_top_damping * (k.rxd - k_top_arrest * k.cp * k.phid - y[11]);
  o.bottom_arrest = bottom_arrest(y.data());
  o.tank = -k_tank_stiffness * y[5] - k_tank_damping * y[11];
  o.slide = k.rx + k.d * k.tan + k_place[1] * (k.sec - 1.0);
  const Turn one = turn(y[2]);
  const double ax = a[6] + braking(t);
  for (int front = 0; front < 2; ++front) {
    const double arm = front == 1 ? k_limb_x : -k_limb_x;
    const double spin2 = y[8] * y[8];
    const double fx = k_mass_limb * (ax - arm * (one.sine * a[8] + one.cosine * spin2));
    const double fy =
        k_mass_limb * (a[7] + k_gravity + arm * (one.cosine * a[8] - one.sine * spin2));
    (front == 1 ? o.fx2 : o.fx3) = fx;
    (front == 1 ? o.fy2 : o.fy3) = fy;
  }
  o.m2 = o.m3 = k_inertia_limb * a[8];
  return o;
}

const char* Transformer::describe(int slot) const {
  static constexpr const char* k_closed[] = {"rear foot unloaded", "front foot unloaded",
                                             "rear block unloaded", "front block unloaded"};
  static constexpr const char* k_held[] = {"rear foot lifts", "front foot lifts",
                                           "rear block lifts", "front block lifts"};
  static constexpr const char* k_open[] = {"rear foot lands", "front foot lands",
                                           "rear block lands", "front block lands"};
  static constexpr const char* k_back[] = {"rear foot loaded", "front foot loaded",
                                           "rear block loaded", "front block loaded"};
  if (slot == k_foot_switch) return "foot switch";
  if (slot >= k_friction_upper) return sticking() ? "slip" : "stick";
  if (slot >= k_return) return k_back[slot - k_return];
  if (contacts_[slot] == ContactMode::closed) return k_closed[slot];
  return contacts_[slot] == ContactMode::held ? k_held[slot] : k_open[slot];
}

} // namespace steplap::peers
