// Slip law of a step-lap joint from the onset to the end of a slip, and the velocity scales that integrators need.
#include "elements/step_lap/step_lap_fit.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Duration of an onset that is resolved, s: k_onset_share times the cube root of the tolerance, between k_onset_time and k_most_onset_time.
// Positions have an error proportional to the third power of that time (docs/explanation/limit_surface.md, section 7).
constexpr double k_onset_share = 2.5e-4, k_most_onset_time = 2.5e-6;
constexpr double k_start_reach = 4.0; // |ν|/δ above which a slip no longer counts as starting
// k_moving: |ν|/δ above which a starting slip counts as moving. A slip that never reaches it, as in a short dip of the clamping pressure,
// ends there. k_backward: below k_moving, backward motion up to k_backward δ is an error of the first steps; it is four times the error of
// velocities in a step (Integrator).
constexpr double k_moving = 0.2, k_backward = 2e-3;
constexpr double k_cone = 0.5; // least cosine of the angle between ν and the stored direction; beyond it the direction is updated
// Time |ν|/(grip acceleration), s, below which a slip is ending: k_end_share times the tolerance, between k_end_time and k_most_end_time.
// The neglected rest of the slip is proportional to this time and to the remaining change of direction.
constexpr double k_end_share = 1e-2, k_most_end_time = 1e-8;
constexpr double k_no_end = 2.0; // a slip has not ended if |ν| exceeds the limit of an ending slip by this factor
// Rounding limits: k_rounded_speed is the |ν|, relative to the velocities of the bodies, at which its direction is lost; k_time_rounding is
// the time of an onset, relative to t, at which steps are still well above rounding.
constexpr double k_rounded_speed = 2.5e-13, k_time_rounding = 2e-12;

// Values of FrictionState::onset_stage, initially 0: a starting slip is moving; a slip is ending.
constexpr std::uint8_t k_moving_stage = 1, k_ending_stage = 1;

template <class Visit> void for_each_corner(const Polygon& polygon, Visit visit) {
  for (const Vec2& corner : polygon.outer) visit(corner);
  for (const Ring& hole : polygon.holes)
    for (const Vec2& corner : hole) visit(corner);
}

bool is_moving(const FrictionState& state) { return state.is_onset && state.onset_stage == k_moving_stage; }
bool is_ending(const FrictionState& state) { return !state.is_onset && state.onset_stage == k_ending_stage; }

} // namespace

void StepLapFriction::Scratch::follow(double tolerance) {
  onset_time = std::clamp(k_onset_share * portable::pow(tolerance, 1.0 / 3.0), k_onset_time, k_most_onset_time);
  end_time = std::clamp(k_end_share * tolerance, k_end_time, k_most_end_time);
}

/// Returns ∇h of the sliding law for the twist ν, equal to that of a Patch made by build(), without storing the patch.
Vec3 StepLapFriction::gradient_at(const Pose& pose, double tilt, const Vec3& nu, Scratch& own) const {
  Vec3 sum = Vec3::Zero();
  for (const SheetPair& s : sheets_) {
    const double traction = traction_of(s, GripLaw::sliding, tilt);
    if (traction == 0.0) continue;
    intersect(s.yoke, s.limb, pose, own.workspace, own.region);
    for (const Polygon& piece : own.region) {
      if (!s.gradient.isZero(0.0))
        for_each_corner(piece, [&](const Vec2& corner) {
          if (!(1.0 + s.gradient.dot(corner - s.middle) >= 0.0)) refuse_pressure();
        });
      sum += gradient_about(piece, {traction, traction * s.gradient}, s.middle, {pose.x, pose.y}, nu, own.spare);
    }
  }
  return sum;
}

/// Returns the twist as the velocity of the joint's centre, and ω times the radius of gyration, m/s.
Vec3 StepLapFriction::scaled(const Vec3& nu) const { return {nu[0] - nu[2] * arm_.y(), nu[1] + nu[2] * arm_.x(), gyration_ * nu[2]}; }

void StepLapFriction::set_direction(FrictionState& state, const Vec3& nu) const {
  const double size = scaled(nu).norm();
  Vec3::Map(state.direction) = size > 0.0 ? Vec3(nu / size) : nu;
}

double StepLapFriction::onset_speed(const Evaluation& e) const {
  return static_cast<const Scratch&>(*e.scratch[index_]).onset_time * grip_acceleration_;
}

double StepLapFriction::end_speed(const Evaluation& e) const {
  const Motion<double>&l = e.motion[hold[0].a], &p = e.motion[hold[0].b];
  const double lever = gyration_ + arm_.norm();
  const double speed = std::abs(l.vx) + std::abs(l.vy) + std::abs(p.vx) + std::abs(p.vy) + lever * (std::abs(l.omega) + std::abs(p.omega));
  const double time = std::max(static_cast<const Scratch&>(*e.scratch[index_]).end_time, k_time_rounding * std::abs(e.t));
  return std::max(time * grip_acceleration_, k_rounded_speed * speed);
}

void StepLapFriction::set_onset_direction(const Evaluation& e, FrictionState& state, const double* wrench) const {
  Fit& f = fit(e.scratch, anchor(e.bases), GripLaw::holding, pressure_at(e.t).tilt);
  state.onset_stage = 0;
  set_direction(state, -required(f.tabulated(), Vec3(wrench[0], wrench[1], wrench[2]), e.t).direction);
}

void StepLapFriction::aim(FrictionState& state, const double* rate) const {
  state.onset_stage = 0;
  set_direction(state, Vec3(rate[0], rate[1], rate[2]));
}

/// Returns the twist for which the slip law is evaluated: ν plus a twist in the stored direction at the start and end of a slip, where ∇h
/// would be undefined.
Vec3 StepLapFriction::law_twist(const Evaluation& e, const FrictionState& state, const Vec3& nu) const {
  const Vec3 n(state.direction[0], state.direction[1], state.direction[2]);
  const Vec3 y = scaled(nu);
  if (state.is_onset) {
    const double delta = onset_speed(e), reach = k_start_reach * delta;
    const double left = 1.0 - y.squaredNorm() / (reach * reach);
    if (left > 0.0) return nu + delta * left * left * left * n;
  } else if (is_ending(state)) {
    return nu + end_speed(e) * n;
  } else if (nu.isZero(0.0)) {
    return n;
  } else if (y.dot(scaled(n)) < 0.0) {
    return -nu;
  }
  return nu;
}

void StepLapFriction::slip_wrench(const Evaluation& e, const FrictionState& state, const double* rate, double* wrench) const {
  const PressureState now = pressure_at(e.t);
  const Vec3 nu = law_twist(e, state, Vec3(rate[0], rate[1], rate[2]));
  Vec3::Map(wrench) = -now.factor * gradient_at(pose_of(e.motion), now.tilt, nu, static_cast<Scratch&>(*e.scratch[index_]));
}

void StepLapFriction::slip_events(const Evaluation& e, const FrictionState& state, const double* rate, double* event_value) const {
  const Vec3 y = scaled(Vec3(rate[0], rate[1], rate[2]));
  const double along = y.dot(scaled(Vec3(state.direction[0], state.direction[1], state.direction[2])));
  const double speed = y.norm();
  if (state.is_onset) {
    const double delta = onset_speed(e);
    event_value[0] = (is_moving(state) ? k_start_reach : k_moving) * delta - speed;
    event_value[1] = along + (is_moving(state) ? end_speed(e) : std::max(end_speed(e), k_backward * delta));
  } else if (is_ending(state)) {
    event_value[0] = along;
    event_value[1] = k_no_end * end_speed(e) - speed;
  } else {
    event_value[0] = speed - end_speed(e);
    event_value[1] = along - k_cone * speed;
  }
}

// Returns the velocity scale to which the slip twist ν is integrated. The friction wrench is ∇h(ν), where h is the support function of the limit
// surface, so a small change of the direction of ν changes it by ∇²h: strongly for narrow sheets, or if the centre of rotation lies near a
// corner. The measure is |ν| tr ∇²h, with rotations multiplied by the radius of gyration of the pressure: 1.5 F for a translation of a round
// overlap with capacity F (F across the slip, F/2 by rotation). Where it is larger, the scale is divided by its ratio to 1.5 F.
SlipScale StepLapFriction::slip_scale(const Evaluation& e, const FrictionState& state, const double* rate) const {
  constexpr double k_round = 1.5;
  SlipScale scale;
  scale.lever = portable::hypot(gyration_, arm_.norm());
  const Vec3 nu = law_twist(e, state, Vec3(rate[0], rate[1], rate[2]));
  const double speed = scaled(nu).norm();
  const Patch& patch = fit(e.scratch, pose_of(e.motion), GripLaw::sliding, pressure_at(e.t).tilt).patch;
  const Mat3 curvature = evaluate(patch, nu).hessian;
  const Vec3 turn(arm_.y() / gyration_, -arm_.x() / gyration_, 1.0 / gyration_); // twist of unit scaled rotation
  const double trace = curvature(0, 0) + curvature(1, 1) + turn.dot(curvature * turn);
  const double sharpness = speed * trace / (k_round * patch.force());
  // Below the speed at which a slip ends, velocities need no accuracy.
  scale.speed = std::max(speed / std::max(1.0, sharpness), end_speed(e));
  return scale;
}

// Returns an upper bound of the damping rates, 1/s: their sum, the trace of A ∇²h, since none is negative.
double StepLapFriction::max_damping_rate(const Evaluation& e, const FrictionState& state, const double* rate) const {
  const Pose pose = pose_of(e.motion);
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, pose, GripLaw::sliding, now.tilt);
  const Mat3 curvature = now.factor * evaluate(f.patch, law_twist(e, state, Vec3(rate[0], rate[1], rate[2]))).hessian;
  const Vec3 turned(pose.y, -pose.x, -1.0); // change of ν by rotation of the active part
  return (limb_mobility_[0] + part_mobility_[0]) * (curvature(0, 0) + curvature(1, 1)) + limb_mobility_[1] * curvature(2, 2) +
         part_mobility_[1] * turned.dot(curvature * turned);
}

bool StepLapFriction::continue_slip(const Evaluation& e, FrictionState& state, const double* rate, FrictionWatch fired) const {
  const Vec3 y = scaled(Vec3(rate[0], rate[1], rate[2]));
  const double along = y.dot(scaled(Vec3(state.direction[0], state.direction[1], state.direction[2])));
  const double speed = y.norm(), end = end_speed(e);
  const auto goes_on = [&state](std::uint8_t stage) {
    state.onset_stage = stage;
    return true;
  };
  const auto rests = [&state] {
    state.onset_stage = 0;
    return false;
  };
  if (state.is_onset) {
    if (fired == FrictionWatch::second) return rests();
    if (!is_moving(state)) return goes_on(k_moving_stage);
  } else if (is_ending(state)) {
    if (along <= 0.0) return rests();
    if (speed <= k_no_end * end) return true;
  } else if (fired == FrictionWatch::first || speed < end) {
    if (fired == FrictionWatch::first) aim(state, rate);
    else if (along <= 0.0) return rests(); // ν reversed within a step, through ν = 0 along a line
    return goes_on(k_ending_stage);
  }
  state.is_onset = false;
  aim(state, rate);
  return true;
}

// Returns true if the utilisation needs no iteration: the wrench of a sliding joint is that of the slip law, on the boundary of the kinetic
// set. Its ratio to the static boundary and the maximising twist are known.
bool StepLapFriction::has_usage_for(const Snapshot& s, const Vec3& wrench) const {
  return !is_elastic() && s.evaluation->friction[index_].phase == FrictionPhase::slip && slip_usage_ == slip_usage_ &&
         !wrench.isZero(0.0) && wrench.allFinite();
}

RequiredPressure StepLapFriction::usage_of_slip(const Snapshot& s, const Pose& pose) const {
  RequiredPressure known;
  Vec3 nu;
  for (int r = 0; r < 3; ++r) nu[r] = evaluate_row<false>(hold[r], s.motion).rate;
  nu = -law_twist(*s.evaluation, s.evaluation->friction[index_], nu);
  known.u = slip_usage_;
  known.direction = nu / scaled(nu).norm();
  known.centre = centre_of_rotation({pose.x, pose.y}, known.direction);
  return known;
}

} // namespace steplap
