// Computes the columns of the reference files from a state of the hand-written transformer.

#include "transformer_kinematics.h"

namespace steplap::peers {

using namespace transformer;

double Transformer::bottom_arrest(const double* y) {
  const Kinematics k = kinematics(y);
  return -k_bottom_stiffness * (k.rx - k_bottom_arrest * k.sp) - k_bottom_damping * (k.rxd - k_bottom_arrest * k.cp * k.phid);
}

Outputs Transformer::outputs(double t, const State& y) {
  State a;
  rates(t, y.data(), a.data());
  const Kinematics k = kinematics(y.data());
  double contact[k_contacts];
  for (int i = 0; i < k_contacts; ++i) contact[i] = contacts_[i] == ContactMode::closed ? force_law(i, k, y.data()) : 0.0;
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
  o.top_arrest = -k_top_stiffness * (k.rx - k_top_arrest * k.sp - y[5]) - k_top_damping * (k.rxd - k_top_arrest * k.cp * k.phid - y[11]);
  o.bottom_arrest = bottom_arrest(y.data());
  o.tank = -k_tank_stiffness * y[5] - k_tank_damping * y[11];
  o.slide = k.rx + k.d * k.tan + k_place[1] * (k.sec - 1.0);
  const Turn one = turn(y[2]);
  const double ax = a[6] + braking(t);
  for (int front = 0; front < 2; ++front) {
    const double arm = front == 1 ? k_limb_x : -k_limb_x;
    const double spin2 = y[8] * y[8];
    const double fx = k_mass_limb * (ax - arm * (one.sine * a[8] + one.cosine * spin2));
    const double fy = k_mass_limb * (a[7] + k_gravity + arm * (one.cosine * a[8] - one.sine * spin2));
    (front == 1 ? o.fx2 : o.fx3) = fx;
    (front == 1 ? o.fy2 : o.fy3) = fy;
  }
  o.m2 = o.m3 = k_inertia_limb * a[8];
  return o;
}

} // namespace steplap::peers
