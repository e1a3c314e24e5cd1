// How a step-lap joint slides: its law from the onset of a slip to its end, and what methods learn of it.
#include "elements/step_lap/step_lap_fit.h"
#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Onsets are followed down to k_onset_time or to this times the cube root of the tolerance, s: by the third power of that time
// positions are off (docs/explanation/limit_surface.md, section 7).
constexpr double k_onset_share = 2.5e-4, k_most_onset_time = 2.5e-6;
constexpr double k_start_reach = 4.0; // |ν|/δ at which a slip no longer counts as starting
// |ν|/δ from which on it moves: up to there, backward motion is an error of the first steps unless it is this share
// of δ, four times what a step's velocities are known to beside |ν| (Integrator). A slip that never gets that far, in a dip of the
// clamping pressure, ends there.
constexpr double k_moving = 0.2, k_backward = 2e-3;
constexpr double k_cone = 0.5; // cosine of the cone about the direction last looked at
// |ν| over grip acceleration from which on a slip ends, s: k_end_time, or this times the tolerance, at most the other. What that
// misses is this time, times what the direction had still to turn by.
constexpr double k_end_share = 1e-2, k_most_end_time = 1e-8;
constexpr double k_no_end = 2.0; // times that |ν|: it has not come to rest after all
// |ν| over speeds to which rounding leaves it a direction; that time over t at which steps are still far from rounding.
constexpr double k_rounding = 2.5e-13, k_time_rounding = 2e-12;

// FrictionState::stage, 0 at first: of a slip that starts, and of one that ends.
constexpr std::uint8_t k_moving_stage = 1, k_ending_stage = 1;

template <class Look> void for_each_corner(const Polygon& polygon, Look look) {
  for (const Vec2& corner : polygon.outer) look(corner);
  for (const Ring& hole : polygon.holes)
    for (const Vec2& corner : hole) look(corner);
}

bool is_moving(const FrictionState& state) { return state.is_starting && state.stage == k_moving_stage; }
bool is_ending(const FrictionState& state) { return !state.is_starting && state.stage == k_ending_stage; }

} // namespace

void StepLapFriction::Scratch::follow(double tolerance) {
  onset_time = std::clamp(k_onset_share * portable::pow(tolerance, 1.0 / 3.0), k_onset_time, k_most_onset_time);
  end_time = std::clamp(k_end_share * tolerance, k_end_time, k_most_end_time);
}

/// ∇h of the sliding law for the twist ν, as that of a Patch made by build(), which nobody else asks for anything.
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

/// Velocity of the joint's centre, and ω as a velocity at the gyration radius.
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
  return std::max(time * grip_acceleration_, k_rounding * speed);
}

void StepLapFriction::begin_slip(const Evaluation& e, FrictionState& state, const double* wrench) const {
  Fit& f = fit(e.scratch, anchor(e.memory), GripLaw::holding, pressure_at(e.t).tilt);
  state.stage = 0;
  set_direction(state, -required(f.tabulated(), Vec3(wrench[0], wrench[1], wrench[2]), e.t).direction);
}

void StepLapFriction::aim(FrictionState& state, const double* rate) const {
  state.stage = 0;
  set_direction(state, Vec3(rate[0], rate[1], rate[2]));
}

/// The twist whose wrench is the slip law's: ν but for the first and the last of a slip.
Vec3 StepLapFriction::law_twist(const Evaluation& e, const FrictionState& state, const Vec3& nu) const {
  const Vec3 n(state.direction[0], state.direction[1], state.direction[2]);
  const Vec3 y = scaled(nu);
  if (state.is_starting) {
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

void StepLapFriction::watch_slip(const Evaluation& e, const FrictionState& state, const double* rate, double* watch) const {
  const Vec3 y = scaled(Vec3(rate[0], rate[1], rate[2]));
  const double along = y.dot(scaled(Vec3(state.direction[0], state.direction[1], state.direction[2])));
  const double speed = y.norm();
  if (state.is_starting) {
    const double delta = onset_speed(e);
    watch[0] = (is_moving(state) ? k_start_reach : k_moving) * delta - speed;
    watch[1] = along + (is_moving(state) ? end_speed(e) : std::max(end_speed(e), k_backward * delta));
  } else if (is_ending(state)) {
    watch[0] = along;
    watch[1] = k_no_end * end_speed(e) - speed;
  } else {
    watch[0] = speed - end_speed(e);
    watch[1] = along - k_cone * speed;
  }
}

// Where a small turn of ν turns the wrench by much (narrow sheets; a centre of rotation near a corner), ν has to be known so
// much better. Measured by |ν| tr ∇²h in scaled twists, which is 1.5 F where a round overlap is translated: F across the
// slip and F/2 from turning (∬ w x² dA is half of F gyration²). Beyond that, ν is asked for as much finer.
SlipScale StepLapFriction::slip_scale(const Evaluation& e, const FrictionState& state, const double* rate) const {
  constexpr double k_round = 1.5;
  SlipScale scale;
  scale.lever = portable::hypot(gyration_, arm_.norm());
  const Vec3 nu = law_twist(e, state, Vec3(rate[0], rate[1], rate[2]));
  const double speed = scaled(nu).norm();
  const Patch& patch = fit(e.scratch, pose_of(e.motion), GripLaw::sliding, pressure_at(e.t).tilt).patch;
  const Mat3 curvature = evaluate(patch, nu).hessian;
  const Vec3 turn(arm_.y() / gyration_, -arm_.x() / gyration_, 1.0 / gyration_); // ν of a scaled turn
  const double trace = curvature(0, 0) + curvature(1, 1) + turn.dot(curvature * turn);
  const double sharpness = speed * trace / (k_round * patch.force());
  // Below the speed of rest there is nothing left to be known.
  scale.speed = std::max(speed / std::max(1.0, sharpness), end_speed(e));
  return scale;
}

// The trace of A ∇²h is the sum of the rates, none of which is negative.
double StepLapFriction::decay_rate(const Evaluation& e, const FrictionState& state, const double* rate) const {
  const Pose pose = pose_of(e.motion);
  const PressureState now = pressure_at(e.t);
  const Fit& f = fit(e.scratch, pose, GripLaw::sliding, now.tilt);
  const Mat3 curvature = now.factor * evaluate(f.patch, law_twist(e, state, Vec3(rate[0], rate[1], rate[2]))).hessian;
  const Vec3 turned(pose.y, -pose.x, -1.0); // of ν as the active part turns
  return (limb_mobility_[0] + part_mobility_[0]) * (curvature(0, 0) + curvature(1, 1)) + limb_mobility_[1] * curvature(2, 2) +
         part_mobility_[1] * turned.dot(curvature * turned);
}

bool StepLapFriction::goes_on_slipping(const Evaluation& e, FrictionState& state, const double* rate, int slot) const {
  const Vec3 y = scaled(Vec3(rate[0], rate[1], rate[2]));
  const double along = y.dot(scaled(Vec3(state.direction[0], state.direction[1], state.direction[2])));
  const double speed = y.norm(), end = end_speed(e);
  const auto goes_on = [&state](std::uint8_t stage) {
    state.stage = stage;
    return true;
  };
  const auto rests = [&state] {
    state.stage = 0;
    return false;
  };
  if (state.is_starting) {
    if (slot == 1) return rests();
    if (!is_moving(state)) return goes_on(k_moving_stage);
  } else if (is_ending(state)) {
    if (along <= 0.0) return rests();
    if (speed <= k_no_end * end) return true;
  } else if (slot == 0 || speed < end) {
    if (slot == 0) aim(state, rate);
    else if (along <= 0.0) return rests(); // through ν = 0 within a step, as along a line
    return goes_on(k_ending_stage);
  }
  state.is_starting = false;
  aim(state, rate);
  return true;
}

// What slides bears the slip law's wrench, which is on the bound of the sliding law: its share of that of the holding one and
// its maximiser need no search.
bool StepLapFriction::knows_usage(const Snapshot& s, const Vec3& wrench) const {
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
