// Yielding of an elastic step-lap joint: slip rate, its direction, and their derivatives for implicit methods. The direction follows from
// the wrench or, at a corner of the limit surface, is a separate state. Twists along a direction are scaled (StepLapFriction::scaled()).
// Wrenches are scaled correspondingly: about the joint's centre, with the moment divided by the radius of gyration.
#include "elements/step_lap/step_lap_fit.h"
#include "mbd/base/diagnostics.h"
#include "mbd/base/number_text.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_trial = 1.01; // largest u at the end of an accepted step; larger values belong to stages of rejected steps
// Step of finite differences with respect to the acceleration across the sheets, m/s²; pressures are linear in it.
constexpr double k_tilt_step = 1e-3;
// Step of finite differences with respect to the relative displacement of the sheets, m. Rotations move a corner 1 m from the centre by it.
constexpr double k_slid_step = 1e-6;
// Step of finite differences with respect to the direction; the flow is smooth unless an edge passes the centre.
constexpr double k_turn_step = 1e-4;
// Step of finite differences of the flow with respect to the overlap: fraction of the distance slid, and its limits, m. Edges that were
// aligned in the reference pose cross within that distance, and a difference must not extend beyond the crossing.
constexpr double k_overlap_step = 1e-4, k_least_overlap_step = 1e-9, k_most_overlap_step = 1e-7;

/// Returns the flow after the joint has come apart: the strain stays constant.
StepLapFriction::Flow flow_of_gone(const Vec3& rate) {
  StepLapFriction::Flow flow;
  flow.rate = rate;
  flow.speed = 1.0;
  return flow;
}

Pose moved_by(const Pose& pose, double way, const Vec3& n) { return {pose.x + way * n[0], pose.y + way * n[1], pose.theta + way * n[2]}; }

/// Returns the smaller of the two curvatures across a twist. The twist itself is in the null space of c, so both follow from their sum
/// (trace) and product (sum of principal minors).
double lesser_curvature(const Mat3& c) {
  const auto minor = [&c](int i, int j) { return c(i, i) * c(j, j) - c(i, j) * c(j, i); };
  const double sum = c.trace(), product = std::max(0.0, minor(0, 1) + minor(1, 2) + minor(2, 0));
  const double larger = 0.5 * (sum + std::sqrt(std::max(0.0, sum * sum - 4.0 * product)));
  return larger > 0.0 ? product / larger : 0.0;
}

} // namespace

void StepLapFriction::refuse_snap(double t) const {
  throw NumericalFailure("step_lap_joint '" + name_ + "', t = " + number_text(t) +
                         " s: loses overlap faster than its spring releases the load: it snaps through. Give it more "
                         "tangential stiffness, or leave it rigid");
}

// Computes ∂h/∂p along n and the change of h with the pressures by central differences. Their contributions to the balance are small:
// strain at the bound over width of the overlap.
StepLapFriction::Flow StepLapFriction::flow_under(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& rate) const {
  Flow flow;
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  if (has_separated(f)) return flow_of_gone(rate);
  if (!force.allFinite()) return flow;
  const RequiredPressure need = required(f.patch, force / now.factor, e.t);
  const Vec3 n = need.direction, pull = stiffness_ * n;
  auto& own = static_cast<Scratch&>(*e.scratch[index_]);
  Fit& moved = own.fits[1]; // scratch memory: an elastic joint has equal friction coefficients and uses only fits[0]
  const double step = k_slid_step * std::min(1.0, gyration_);
  const auto power = [&](double way, double tilt) {
    build({slid.x + way * n[0], slid.y + way * n[1], slid.theta + way * n[2]}, GripLaw::holding, tilt, own.workspace, own.region,
          moved.patch);
    return moved.patch.empty() ? 0.0 : evaluate_gradient(moved.patch, n).h;
  };
  moved.is_valid = false;
  const double change = now.factor * (power(step, now.tilt) - power(-step, now.tilt)) / (2.0 * step);
  double tightening =
      now.factor_rate == 0.0 ? 0.0 : now.factor_rate * evaluate_gradient(f.patch, n).h; // rate of change of h at a slip of 1 m/s, W/s
  if (now.tilt_rate != 0.0)
    tightening +=
        now.factor * now.tilt_rate * (power(0.0, now.tilt + k_tilt_step) - power(0.0, now.tilt - k_tilt_step)) / (2.0 * k_tilt_step);
  flow.direction = n;
  flow.resistance = n.dot(pull) + need.u * change;
  if (!(flow.resistance > 0.0) && need.u > k_trial) { // stage of a step that is too long and will be rejected
    flow.rate = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return flow;
  }
  if (!(flow.resistance > 0.0)) refuse_snap(e.t);
  flow.speed = (pull.dot(rate) - need.u * tightening) / flow.resistance;
  flow.rate = flow.speed * n;
  flow.roundness = roundness(e, slid, scaled(n));
  return flow;
}

Vec3 StepLapFriction::unscaled(const Vec3& y) const {
  const double omega = y[2] / gyration_;
  return {y[0] + omega * arm_.y(), y[1] - omega * arm_.x(), omega};
}

/// Returns h of a patch with first derivatives with respect to scaled twists; second derivatives if requested.
Dissipation StepLapFriction::friction_along(const Patch& patch, const Vec3& y, bool with_curvature) const {
  const Vec2 centre = patch.reference() + arm_;
  const Vec3 twist(y[0], y[1], y[2] / gyration_);
  Dissipation d = with_curvature ? evaluate_about(patch, centre, twist) : evaluate_gradient_about(patch, centre, twist);
  d.gradient[2] /= gyration_;
  d.hessian.row(2) /= gyration_;
  d.hessian.col(2) /= gyration_;
  return d;
}

Vec3 StepLapFriction::direction_of(const Evaluation& e, const Pose& slid, const Vec3& force) const {
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  if (has_separated(f)) return Vec3::Zero();
  return scaled(required(f.patch, force / now.factor, e.t).direction).normalized();
}

double StepLapFriction::roundness(const Evaluation& e, const Pose& slid, const Vec3& direction) const {
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, pressure_at(e.t).tilt);
  return has_separated(f) ? 1.0 : lesser_curvature(friction_along(f.patch, direction.normalized(), true).hessian) / f.patch.force();
}

Vec3 StepLapFriction::bound_along(const Evaluation& e, const Pose& slid, const Vec3& direction) const {
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  return now.factor * evaluate_gradient(f.patch, unscaled(direction)).gradient;
}

// The friction force changes along the slip with the overlap, and in time with the pressures. Both derivatives are central differences;
// their contributions to the balance are small: strain at the bound over width of the overlap.
StepLapFriction::Flow StepLapFriction::flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                                  const Vec3& rate) const {
  const PressureState now = pressure_at(e.t);
  auto& own = static_cast<Scratch&>(*e.scratch[index_]);
  const FlowQuestion question{{slid.x, slid.y, slid.theta}, force, direction, rate, now};
  if (!(own.last_flow_question && *own.last_flow_question == question)) {
    own.flow_answer = find_flow_along(e, slid, force, direction, rate);
    own.last_flow_question = question;
  }
  return own.flow_answer;
}

StepLapFriction::Flow StepLapFriction::find_flow_along(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                                       const Vec3& rate) const {
  Flow flow;
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, slid, GripLaw::holding, now.tilt);
  if (has_separated(f)) return flow_of_gone(rate);
  const Vec3 y = direction.normalized(), n = unscaled(y), moving = scaled(rate);
  flow.direction = n;
  const Dissipation d = friction_along(f.patch, y, true);
  auto& own = static_cast<Scratch&>(*e.scratch[index_]);
  Fit& moved = own.fits[1]; // scratch memory: an elastic joint has equal friction coefficients and uses only fits[0]
  moved.is_valid = false;
  const double step = k_slid_step * std::min(1.0, gyration_);
  const auto bound = [&](double way, double tilt) {
    build(moved_by(slid, way, n), GripLaw::holding, tilt, own.workspace, own.region, moved.patch);
    return moved.patch.empty() ? Vec3(Vec3::Zero()) : Vec3(friction_along(moved.patch, y, false).gradient);
  };
  const Vec3 loosening = now.factor * (bound(step, now.tilt) - bound(-step, now.tilt)) / (2.0 * step);
  Vec3 tightening = now.factor_rate * d.gradient;
  if (now.tilt_rate != 0.0)
    tightening +=
        now.factor * now.tilt_rate * (bound(0.0, now.tilt + k_tilt_step) - bound(0.0, now.tilt - k_tilt_step)) / (2.0 * k_tilt_step);

  const Vec3 pull = scaled_stiffness_ * y;
  flow.resistance = y.dot(pull + loosening);
  if (!(flow.resistance > 0.0) && !(force.dot(n) <= k_trial * now.factor * d.h)) { // stage of a step that is too long and will be rejected
    flow.rate = flow.turning = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return flow;
  }
  if (!(flow.resistance > 0.0)) refuse_snap(e.t);
  flow.speed = (pull.dot(moving) - y.dot(tightening)) / flow.resistance;
  flow.rate = flow.speed * n;
  // The range of the curvature is orthogonal to y. The added term along y makes the matrix invertible and does not change the result.
  flow.roundness = lesser_curvature(d.hessian) / f.patch.force();
  const double size = now.factor * f.patch.force();
  flow.turn = (now.factor * d.hessian + size * y * y.transpose()).ldlt().solve(Mat3::Identity());
  flow.turning = flow.turn * (scaled_stiffness_ * (moving - flow.speed * y) - flow.speed * loosening - tightening);
  flow.relaxation = 0.5 * flow.speed * (flow.turn * scaled_stiffness_).trace();
  flow.turning += flow.relaxation * (1.0 - direction.norm()) * y;
  flow.by_speed = pull + loosening;
  return flow;
}

StepLapFriction::FlowSlopes StepLapFriction::flow_slopes(const Evaluation& e, const Pose& slid, const Vec3& force, const Vec3& direction,
                                                         const Vec3& rate) const {
  FlowSlopes slopes;
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  const Flow here = flow_along(e, slid, force, direction, rate);
  const auto at = [&](const Pose& pose, const Vec3& along) {
    const Flow there = find_flow_along(e, pose, force, along, rate);
    return Vec6((Vec6() << there.rate, there.turning).finished());
  };
  const Vec3 y = direction.normalized();
  const Pose& reference = reference_->pose;
  const double far = scaled({slid.x - reference.x, slid.y - reference.y, slid.theta - reference.theta}).norm();
  const double turn = k_turn_step * direction.norm(), way = std::clamp(k_overlap_step * far, k_least_overlap_step, k_most_overlap_step);
  for (int c = 0; c < 3; ++c) {
    const Vec3 moved = Vec3::Unit(c) / (c < 2 ? 1.0 : gyration_);
    slopes.by_slid.col(c) =
        (at(moved_by(slid, way, moved), direction) - at(moved_by(slid, -way, moved), direction)) / (2.0 * way * moved[c]);
  }
  // Derivatives across y are finite differences. Along y only the length changes, which relaxes to 1.
  slopes.by_direction.bottomRows<3>() = -here.relaxation * y * y.transpose();
  const Vec3 side = y.unitOrthogonal();
  for (const Vec3& across : {side, Vec3(y.cross(side))})
    slopes.by_direction += (at(slid, direction + turn * across) - at(slid, direction - turn * across)) / (2.0 * turn) * across.transpose();
  const Vec3 pull = scaled_stiffness_ * y;
  Mat3 scale; // converts twists to scaled ones
  for (int c = 0; c < 3; ++c) scale.col(c) = scaled(Vec3::Unit(c));
  const Eigen::RowVector3d speed = pull.transpose() * scale / here.resistance;
  slopes.by_rate.topRows<3>() = unscaled(y) * speed;
  slopes.by_rate.bottomRows<3>() = here.turn * (scaled_stiffness_ * scale - here.by_speed * speed);
  return slopes;
}

} // namespace steplap
