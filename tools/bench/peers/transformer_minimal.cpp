// Equations of motion of the hand-written transformer.

#include "transformer_kinematics.h"

namespace steplap::peers {

using namespace transformer;

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

void Transformer::rates(double t, const double* y, double* dydt) {
  ++evaluations_;
  // Derivatives are written at the end, because the compiler must assume that dydt may alias members.
  const Kinematics k = kinematics(y);
  const double w = y[10];
  const double s4 = y[5];
  const double s4d = y[11];

  // Generalised forces for rx, ry, φ and s4.
  double px = 0.0, py = 0.0, pphi = 0.0, ps = 0.0;
  double normal = 0.0;
  const double foot_height = k.d * k.sec + (foot_offset_ - k_height_active);
  const double foot_lever = k.d * k.sec * k.tan;
  const double foot_rate = k.ryd * k.sec + foot_lever * k.phid;
  const bool rear = contacts_[0] == ContactMode::closed;
  const bool front = contacts_[1] == ContactMode::closed;
  if (rear || front) {
    // For both feet δ = height ± tan φ, with the rate foot_rate ± φ̇ sec² φ. Their forces are computed from half the sum and half the
    // difference.
    const double mean = -k_foot_stiffness * foot_height - k_foot_damping * foot_rate;
    const double tilt = -k_foot_stiffness * k.tan - k_foot_damping * k.sec2 * k.phid;
    const double f_rear = rear ? mean - tilt : 0.0;
    const double f_front = front ? mean + tilt : 0.0;
    normal = f_rear + f_front;
    py = normal * k.sec;
    pphi = normal * foot_lever + (f_front - f_rear) * k.sec2;
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
  const double top = -k_top_stiffness * (k.rx - k_top_arrest * k.sp - s4) - k_top_damping * (k.rxd - k_top_arrest * k.cp * k.phid - s4d);
  const double bottom =
      -k_bottom_stiffness * (k.rx - k_bottom_arrest * k.sp) - k_bottom_damping * (k.rxd - k_bottom_arrest * k.cp * k.phid);
  px += top + bottom;
  pphi -= (k_top_arrest * top + k_bottom_arrest * bottom) * k.cp;
  ps -= top + k_tank_stiffness * s4 + k_tank_damping * s4d;

  const double s_phi = (k.d + k_place[foot_] * k.sp) * k.sec2; // ∂s/∂φ
  if (friction_ == FrictionMode::slip_forward || friction_ == FrictionMode::slip_backward) {
    const double force = friction_ == FrictionMode::slip_forward ? -k_friction * normal : k_friction * normal;
    px += force;
    py += force * k.tan;
    pphi += force * s_phi;
  }

  // Generalised forces for the ground-fixed coordinates. The right-hand side includes the inertia of the prescribed x5 and the velocity
  // terms of body 4.
  const double a5 = braking(t);
  const double fx = k.c * px - k.s * py;
  const double fy = k.s * px + k.c * py;
  const double heave = y[3] - k_height_lower + k_suspension_drop * k.versine;
  const double heave_rate = y[9] - k_suspension_drop * k.s * w;
  const double lift = (k_mass_active + k_mass_upper + k_mass_lower) * k_gravity -
                      2.0 * (k_suspension_stiffness * heave + k_suspension_damping * heave_rate);
  const double righting = 2.0 * k_suspension_arm * k_suspension_arm * (k_suspension_stiffness * k.s + k_suspension_damping * k.c * w);
  const double bx = -w * w * s4;
  const double by = w * (2.0 * s4d - w * k_rise_upper);
  const double q_y = lift - fy - (k_mass_upper + k_mass_lower) * k_gravity - k_mass_upper * (k.s * bx + k.c * by);
  const double q_theta = px * k.ry - py * k.rx - pphi - k_suspension_drop * k.s * lift - k.c * righting -
                         k_mass_upper * k_gravity * (k.c * s4 - k.s * k_rise_upper) - 2.0 * k_mass_upper * s4 * w * s4d +
                         k_mass_upper * (k.s * s4 + k.c * k_rise_upper) * a5;
  const double q_s = ps - k_mass_upper * (k_gravity * k.s + bx + k.c * a5);

  // The mass matrix of the active part is diagonal. That of the tank is reduced to 2 × 2 by eliminating s4.
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

  if (friction_ == FrictionMode::stick) { // J a = γ gives J M⁻¹ Jᵀ λ = γ − J a_f
    const double jx = k.c - k.s * k.tan;
    const double jy = k.s + k.c * k.tan;
    const double j5 = k.ry - k.tan * k.rx - s_phi;
    const double bias =
        w * (2.0 * k.un - w * k.rx) - w * (2.0 * k.ut + w * k.ry) * k.tan +
        k.sec2 * k.phid * (2.0 * k.ryd + 2.0 * k.d * k.tan * k.phid + k_place[foot_] * k.sec * (1.0 + k.sp * k.sp) * k.phid);
    const double u1 = -m22 * jy - m12 * j5; // tank part of M⁻¹ Jᵀ, times the determinant
    const double u2 = m11 * j5 + m12 * jy;
    const double mobility = k.sec2 * k_inv_mass + s_phi * s_phi * k_inv_inertia + (j5 * u2 - jy * u1) * inv_det;
    const double inv_mobility = 1.0 / mobility;
    const double lambda = -(bias + jx * ax + jy * (ay - ay5) + s_phi * at + j5 * at5) * inv_mobility;
    const double by_det = lambda * inv_det;
    ax += jx * (lambda * k_inv_mass);
    ay += jy * (lambda * k_inv_mass);
    at += s_phi * (lambda * k_inv_inertia);
    ay5 += u1 * by_det;
    at5 += u2 * by_det;
    as4 += (k_rise_upper * u2 - k.s * u1) * by_det;
    lambda_ = lambda;
    stick_margin_ = std::min(stick_margin_, k_friction * normal - std::abs(lambda));
  }
  normal_ = normal;
  for (int i = 0; i < 6; ++i) dydt[i] = y[6 + i];
  dydt[6] = ax;
  dydt[7] = ay;
  dydt[8] = at;
  dydt[9] = ay5;
  dydt[10] = at5;
  dydt[11] = as4;
}

} // namespace steplap::peers
