// The tank with its hanging lid: statics and vibrations from the energies of four coordinates, written down by hand.
#include "mbd/rest/modes.h"
#include "tests/machines/machine.h"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

using Vec4 = Eigen::Vector4d; ///< the tank's centre x, y, its angle, the lid's angle
using Mat4 = Eigen::Matrix4d;

constexpr double k_g = 9.81;

struct Spring {
  Vec2 foot; ///< on the tank, from its centre of gravity
  Vec2 axis;
  double k, c;
};

// Centre of gravity of the tank at (0.1, 1.5) in the reference pose.
const Spring k_springs[] = {{{-1.1, -0.7}, {0.0, 1.0}, 4e5, 4e3},
                            {{0.9, -0.7}, {0.0, 1.0}, 4e5, 4e3},
                            {{-1.3, -0.5}, {1.0, 0.0}, 1.5e5, 2e3},
                            {{1.1, -0.5}, {1.0, 0.0}, 1.5e5, 2e3}};
const Vec2 k_hinge(0.5, 0.7);
constexpr double k_tank = 3000.0, k_tank_inertia = 2500.0, k_lid = 120.0, k_lid_inertia = 3.6, k_arm = 0.3;
constexpr double k_bushing = 20.0, k_bushing_damping = 4.0;

Vec2 shifted(const Vec4& q, const Vec2& p) { return Vec2(q[0], q[1]) + rotated(p, q[2]); }
Vec2 lid(const Vec4& q) { return shifted(q, k_hinge) + k_arm * Vec2(std::sin(q[3]), -std::cos(q[3])); }

// Springs are without force in the reference pose.
double energy(const Vec4& q) {
  double v = k_g * (k_tank * q[1] + k_lid * lid(q).y()) + 0.5 * k_bushing * (q[3] - q[2]) * (q[3] - q[2]);
  for (const Spring& s : k_springs) {
    const double stretch = s.axis.dot(shifted(q, s.foot) - s.foot);
    v += 0.5 * s.k * stretch * stretch;
  }
  return v;
}

// By q: derivatives of a point's place are exact for small differences of the angles only, so by hand.
Eigen::Matrix<double, 2, 4> gradient(const Vec4& q, const Vec2& p, double arm) {
  const Vec2 r = rotated(p, q[2]);
  Eigen::Matrix<double, 2, 4> j;
  j << 1.0, 0.0, -r.y(), arm * std::cos(q[3]), 0.0, 1.0, r.x(), arm * std::sin(q[3]);
  return j;
}

Vec4 slope(const Vec4& q) {
  Vec4 g = k_g * k_tank * Vec4::UnitY() + k_g * k_lid * gradient(q, k_hinge, k_arm).row(1).transpose();
  const Vec4 twist(0.0, 0.0, -1.0, 1.0);
  g += k_bushing * (q[3] - q[2]) * twist;
  for (const Spring& s : k_springs)
    g += s.k * s.axis.dot(shifted(q, s.foot) - s.foot) * (s.axis.transpose() * gradient(q, s.foot, 0.0)).transpose();
  return g;
}

// Central differences of the slope: rounding 1e-16 of 1e5 over 1e-5, cut off 1e-10.
Mat4 stiffness(const Vec4& q) {
  Mat4 k;
  const double h = 1e-5;
  for (int i = 0; i < 4; ++i) k.col(i) = (slope(q + h * Vec4::Unit(i)) - slope(q - h * Vec4::Unit(i))) / (2.0 * h);
  return 0.5 * (k + k.transpose());
}

} // namespace

TEST_CASE("a tank on springs with a hanging lid rests and vibrates as its four coordinates' energies say") {
  Vec4 q = Vec4::Zero();
  for (int i = 0; i < 30; ++i) q -= stiffness(q).ldlt().solve(slope(q));
  REQUIRE(slope(q).norm() < 1e-8);
  CHECK(energy(q) < energy(q + Vec4(0.0, 0.0, 1e-4, 0.0)));

  const auto loaded = machine("tank_with_lid");
  const Equilibrium rest = equilibrium_of(*loaded);
  // Rest is found to accelerations of 1e-13 m/s², these matrices' Newton steps to some 1e-13 m.
  const double wanted[] = {0.1 + q[0], 1.5 + q[1], q[2], q[3]};
  const char* channels[] = {"tank.x", "tank.y", "tank.theta", "lid.theta"};
  for (int i = 0; i < 4; ++i) CHECK(std::abs(at_rest(*loaded, rest, channels[i]) - wanted[i]) < 1e-11);

  Mat4 mass = Vec4(k_tank, k_tank, k_tank_inertia, k_lid_inertia).asDiagonal();
  const auto to_lid = gradient(q, k_hinge, k_arm);
  mass += k_lid * to_lid.transpose() * to_lid;
  const Vec4 twist(0.0, 0.0, -1.0, 1.0);
  Mat4 damping = k_bushing_damping * twist * twist.transpose();
  for (const Spring& s : k_springs) {
    const Vec4 along = (s.axis.transpose() * gradient(q, s.foot, 0.0)).transpose();
    damping += s.c * along * along.transpose();
  }
  Eigen::Matrix<double, 8, 8> state = Eigen::Matrix<double, 8, 8>::Zero();
  state.topRightCorner<4, 4>().setIdentity();
  state.bottomLeftCorner<4, 4>() = -mass.ldlt().solve(stiffness(q));
  state.bottomRightCorner<4, 4>() = -mass.ldlt().solve(damping);
  const auto values = Eigen::EigenSolver<Eigen::Matrix<double, 8, 8>>(state).eigenvalues();

  State still = rest.state;
  std::fill(still.v.begin(), still.v.end(), 0.0);
  const VibrationModes found = vibration_modes(*loaded->system, still);
  REQUIRE(found.modes.size() == 4);
  CHECK(found.rigid_motions == 0);
  for (const VibrationMode& mode : found.modes) {
    double off = 1e9;
    for (const auto& value : values) off = std::min(off, size_of(value - mode.eigenvalue));
    CHECK(off < 1e-8 * size_of(mode.eigenvalue)); // the differences of the stiffness
  }
  // The lid, near plumb, much as a pendulum from a fixed hinge: sqrt(m g d + k)/(J + m d²), the tank gives by a hundredth.
  const double alone = std::sqrt((k_lid * k_g * k_arm + k_bushing) / (k_lid_inertia + k_lid * k_arm * k_arm));
  CHECK(std::abs(size_of(found.modes[0].eigenvalue) / alone - 1.0) < 0.2);
}
