#include "mbd/trust/known_to.h"

#include "mbd/base/portable_math.h"
#include "mbd/system/rounding.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

double radius_of(const BodyData& body) { return body.mass > 0.0 && body.inertia > 0.0 ? std::sqrt(body.inertia / body.mass) : 1.0; }

// Accuracy of pose and velocity of one body: of its position along both axes, m and m/s, and of its angle, rad and rad/s.
struct BodyAccuracy {
  double place = 0.0, angle = 0.0, rate = 0.0, spin = 0.0;
};

BodyAccuracy of_body(const System& system, int b, const Motion<double>& m, double met) {
  if (b == k_ground) return {};
  const double size = std::abs(m.x) + std::abs(m.y) + radius_of(system.bodies[static_cast<std::size_t>(b)]);
  return {met + k_rounded_sum * size, met + k_rounded_sum * std::abs(m.theta), met + k_rounded_sum * (std::abs(m.vx) + std::abs(m.vy)),
          met + k_rounded_sum * std::abs(m.omega)};
}

// Returns the error of the force in one row of a pair's Jacobian J: Σ |J| · accuracy, over the six coordinates of the pair.
double changed_by(const PairJacobian& pair, int row, const BodyAccuracy& a, const BodyAccuracy& b) {
  const double pose[6] = {a.place, a.place, a.angle, b.place, b.place, b.angle};
  const double velocity[6] = {a.rate, a.rate, a.spin, b.rate, b.rate, b.spin};
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += std::abs(pair.stiffness(row, i)) * pose[i] + std::abs(pair.damping(row, i)) * velocity[i];
  return sum;
}

} // namespace

MotionAccuracy known_to(const System& system, const Snapshot& s, double met, std::vector<PairJacobian>& scratch) {
  const std::size_t count = system.bodies.size();
  std::vector<BodyAccuracy> bodies(count);
  for (std::size_t b = 0; b < count; ++b) bodies[b] = of_body(system, static_cast<int>(b), s.motion[b], met);
  scratch.clear();
  for (const auto& group : system.groups) group->add_jacobian(*s.evaluation, scratch);
  std::vector<double> force(count, 0.0);
  for (const PairJacobian& pair : scratch)
    for (const int side : {0, 1}) {
      const int body = side == 0 ? pair.a : pair.b;
      if (body == k_ground) continue;
      const BodyAccuracy &a = bodies[static_cast<std::size_t>(pair.a)], &b = bodies[static_cast<std::size_t>(pair.b)];
      const double fx = changed_by(pair, 3 * side, a, b), fy = changed_by(pair, 3 * side + 1, a, b);
      const double couple = changed_by(pair, 3 * side + 2, a, b) / radius_of(system.bodies[static_cast<std::size_t>(body)]);
      const double on_it = portable::hypot(portable::hypot(fx, fy), couple);
      if (std::isfinite(on_it)) force[static_cast<std::size_t>(body)] += on_it;
    }
  MotionAccuracy known;
  for (std::size_t b = 1; b < count; ++b) {
    const double mass = system.bodies[b].mass;
    known.force = std::max(known.force, force[b]);
    const double swing = mass > 0.0 ? std::sqrt(bodies[b].place * force[b] / mass) : 0.0;
    known.rate = std::max(known.rate, bodies[b].rate + swing);
  }
  return known;
}

double position_accuracy(const System& system, const Snapshot& s, double met) {
  double known = 0.0;
  for (int b = 1; b < system.body_count(); ++b) known = std::max(known, of_body(system, b, s.motion[b], met).place);
  return known;
}

double row_rate_known_to(const RowSpec& row, const Snapshot& s, double met) {
  double known = met;
  for (const RowSpec* part = &row; part; part = part->next) {
    const Motion<double>&a = s.motion[part->a], &b = s.motion[part->b];
    known += rate_rounding(evaluate_row<false>(*part, a, b), a, b);
  }
  return known;
}

} // namespace steplap
