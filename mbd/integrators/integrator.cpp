#include "mbd/integrators/integrator.h"

#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/integrators/scene_rate.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Scales below which errors are absolute. Positions: a thousandth of the radius of gyration. Velocities: that length times k_rate_floor
// times the characteristic rate of the scene (scene_rate.h); for bodies of 1 m the product of the two is 60/s (10 Hz). Above these
// scales errors are relative to displacement and velocity.
constexpr double k_displacement_floor = 1e-3;
constexpr double k_rate_floor = 60.0 / k_metre_rate;
// Weight of the error component that projection onto the constraints removes. It is not zero, because the directions of the constraints
// change within a step.
constexpr double k_turned_share = 1e-4;
// Joints inside clusters that are far from their limits are evaluated about twice within a step, at intervals of 0.25 of its length, but
// not in its last 1/16, since they are evaluated at its end in any case.
constexpr double k_rigid_joint_interval = 0.25, k_merged_end = 0.0625;
// Shortest attempt, relative to time, after the constraints could not be satisfied at the end of a step or an element has failed in it.
constexpr double k_shortest_try = 1e-12;
// Accuracy of positions and velocities that rounding permits: relative, and absolute in m, rad, m/s, rad/s.
constexpr double k_finest_accuracy = 1e-12;
// Errors of slip velocities stay below this fraction of the slip speed, whatever the tolerance. At the start and end of a slip, |ν| → 0, an
// error of the size of the tolerance would give the friction an arbitrary direction.
constexpr double k_slip_share = 5e-4;
// The error norm is a mean over the numbers of the state, so that many bodies dilute a single slip. Above this count, about that of
// eight bodies, slip velocities get a correspondingly larger weight.
constexpr double k_slip_numbers = 50.0;
// Least speed of a slip within a step, relative to the start of the step. Errors of k_slip_share of the initial speed then stay below
// 1/200 of the speed anywhere in the step, and so does the rotation of the slip direction that they cause. Speeds are compared instead
// of the scales of coordinates, because these also change with levers: the scale of an angle about the contact point itself is infinite.
constexpr double k_least_slip = 0.1;
// Length of the next attempt, relative to the position in the step where the slip was too slow. With this factor a uniformly decelerated
// slip keeps a fifth of its speed.
constexpr double k_shorter_slip = 0.8;
// Permitted error of slip velocities in a finer run: halving the steps divides the error of a method of order 5, the lowest used here,
// by 32.
double slip_share(int division) { return k_slip_share / (static_cast<double>(division) * division * division * division * division); }

} // namespace

Integrator::Integrator(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
    : system_(dynamics.system()), settings_(settings), y0_(max_dimension, 0.0), y1_(max_dimension, 0.0), weight_(max_dimension, 0.0),
      scratch_(3 * max_dimension, 0.0), event_value0_(system_.event_count, 1.0), event_value1_(event_value0_),
      event_derivative0_(event_value0_), event_derivative1_(event_value0_), nodes_(system_.event_count), turn_limit_(system_),
      rate_rounding_(max_dimension), slip_scale0_(max_dimension, 0.0), slip_scale1_(slip_scale0_), slip_scale_inside_(slip_scale0_) {
  double size = 0.0;
  for (const BodyData& body : system_.bodies)
    if (body.mass > 0.0) size = std::max(size, std::sqrt(body.inertia / body.mass));
  length_scale_ = size > 0.0 ? size : 1.0;
  rate_floor_ = k_rate_floor * scene_rate(system_);
}

void Integrator::begin_at(Dynamics& dynamics, double t, const double* y) {
  n_ = dynamics.dimension();
  dynamics.begin_stages();
  t0_ = t1_ = t;
  std::copy(y, y + n_, y0_.begin());
  rate_rounding_.restart();
  on_restart(dynamics);
}

void Integrator::restart(Dynamics& dynamics, double t, const double* y) {
  begin_at(dynamics, t, y);
  dynamics.rates(t, y0_.data(), k0_);
  dynamics.evaluate_rigid_joint_events(k0_);
  note_begin(dynamics);
}

void Integrator::restart_evaluated(Dynamics& dynamics, double t, const double* y, const double* dy) {
  begin_at(dynamics, t, y);
  std::copy(dy, dy + n_, k0_);
  note_begin(dynamics);
}

void Integrator::note_begin(Dynamics& dynamics) {
  event_value0_ = dynamics.event_value();
  event_derivative0_ = dynamics.event_derivative();
  is_restarted_ = true;
  note_slips(dynamics, slip_scale0_, has_slip_scale0_);
}

void Integrator::note_slips(Dynamics& dynamics, std::vector<double>& scale, bool& is_any) {
  is_any = is_adaptive() && dynamics.slip_scales(scale.data());
  decay_rate_ = is_adaptive() ? 0.0 : dynamics.slip_decay_rate();
}

bool Integrator::resolves_slips(Dynamics& dynamics, double theta, const double* y) {
  if (!has_slip_scale0_) return true;
  const std::vector<double>* scale = &slip_scale1_;
  if (theta < 1.0) {
    dynamics.rates(t0_ + theta * h_, y, scratch_.data());
    if (!dynamics.slip_scales(slip_scale_inside_.data())) return true;
    scale = &slip_scale_inside_;
  }
  const int m = dynamics.coordinate_count();
  for (int i = m; i < 2 * m; ++i)
    if ((*scale)[i] < k_least_slip * slip_scale0_[i]) return !withdraw(dynamics, k_shorter_slip * theta * h_);
  return true;
}

void Integrator::note_divided(double h) {
  ++divided_.count;
  if (!turn_limit_.limiting() || h >= divided_.shortest) return;
  divided_.shortest = h;
  divided_.a = turn_limit_.limiting()->a;
  divided_.b = turn_limit_.limiting()->b;
}

double Integrator::rate_accuracy(const Dynamics& dynamics) const {
  const int m = dynamics.coordinate_count();
  double fastest = 0.0;
  for (int i = 0; i < m; ++i) fastest = std::max(fastest, std::abs(y1_[m + i]));
  const double tolerance = is_adaptive() ? std::max(settings_.tolerance, k_finest_accuracy) : k_finest_accuracy;
  return tolerance * (rate_floor_ * k_displacement_floor * length_scale_ + fastest) + k_finest_accuracy;
}

double Integrator::place_accuracy(const Dynamics& dynamics) const {
  const Layout& layout = dynamics.layout();
  double farthest = 0.0;
  for (int i = 0; i < dynamics.coordinate_count(); ++i) farthest = std::max(farthest, std::abs(y1_[i] - layout.reference[i]));
  const double tolerance = is_adaptive() ? std::max(settings_.tolerance, k_finest_accuracy) : k_finest_accuracy;
  return tolerance * (k_displacement_floor * length_scale_ + farthest) + k_finest_accuracy;
}

bool Integrator::end_at(Dynamics&, double) { return false; }

void Integrator::refuse_shorter_than_rounding(double h) const {
  const bool is_positive = h > 0.0; // rates beyond all numbers give zero or NaN
  if (!is_positive || h < 16.0 * std::numeric_limits<double>::epsilon() * rounding_time_scale(t0_, system_))
    throw NumericalFailure("step size fell to " + rounded_text(h, 3) + " s at t = " + rounded_text(t0_, 12) +
                           " s: the motion becomes singular there, or the tolerance is too small");
}

SingularCrossing::Step Integrator::crossing_step(Dynamics& dynamics) {
  SingularCrossing::Step step;
  step.t0 = t0_;
  step.h = h_;
  step.y0 = y0_.data();
  step.rate0 = k0_;
  step.n = n_;
  step.norm = [this](const double* error) { return error_norm(error); };
  step.record_stage = [this, &dynamics](const double* rates, double theta) { record_stage_events(dynamics, rates, theta); };
  return step;
}

void Integrator::accept() {
  t0_ = t1_;
  std::swap(y0_, y1_);
  std::copy(k1_, k1_ + n_, k0_);
  std::swap(event_value0_, event_value1_);
  std::swap(event_derivative0_, event_derivative1_);
  std::swap(slip_scale0_, slip_scale1_);
  has_slip_scale0_ = has_slip_scale1_;
}

void Integrator::finish_step(Dynamics& dynamics) {
  const Residual found = dynamics.project(t1_, y1_.data(), settings_.projection_tolerance);
  residual_.position = std::max(residual_.position, found.position);
  residual_.velocity = std::max(residual_.velocity, found.velocity);
  if (is_adaptive() || !are_dense_evaluations_expected_) {
    dynamics.evaluate(Request::end, t1_, y1_.data(), k1_);
  } else { // fixed steps: event functions are used only at the ends of the step
    dynamics.rates(t1_, y1_.data(), k1_);
    dynamics.evaluate_rigid_joint_events(k1_);
  }
  event_value1_ = dynamics.event_value();
  event_derivative1_ = dynamics.event_derivative();
  note_slips(dynamics, slip_scale1_, has_slip_scale1_);
  is_restarted_ = false;
}

bool Integrator::is_shortest_try(double h) const { return h < k_shortest_try * rounding_time_scale(t0_, system_); }

bool Integrator::try_finish_step(Dynamics& dynamics) {
  const bool is_shortest = is_shortest_try(h_);
  try {
    finish_step(dynamics);
    return true;
  } catch (const ConstraintFailure&) {
    if (is_shortest) throw;
  } catch (const ElementFailure&) { // the step ends near a singular position of the joints
    if (is_shortest) throw;
  }
  return false;
}

bool Integrator::are_rigid_joint_events_due(double theta) const {
  return theta > last_rigid_joint_evaluation_ + k_rigid_joint_interval && theta < 1.0 - k_merged_end;
}

void Integrator::evaluate_stage(Dynamics& dynamics, double t, const double* y, double* dy, double theta) {
  const bool is_due = are_rigid_joint_events_due(theta);
  if (is_due) last_rigid_joint_evaluation_ = theta;
  const bool has_merged = dynamics.needs_rigid_joint_events(is_due);
  dynamics.evaluate(is_due ? Request::stage_and_joints : Request::stage_near_limit, t, y, dy);
  nodes_.add(theta, dynamics.event_value().data(), has_merged);
}

void Integrator::record_stage_events(Dynamics& dynamics, const double* dy, double theta) {
  const bool is_due = are_rigid_joint_events_due(theta);
  if (is_due) last_rigid_joint_evaluation_ = theta;
  dynamics.evaluate_rigid_joint_events_if_near_limit(dy, is_due);
  nodes_.add(theta, dynamics.event_value().data(), dynamics.needs_rigid_joint_events(is_due));
}

// Precondition: the weights refer to y0_, and h_ is the length of the step before.
void Integrator::note_rounding() {
  if (!rate_rounding_.is_known()) return;
  for (int i = 0; i < n_; ++i) {
    const double share = rate_rounding_.over_step(i, h_) * weight_[i]; // of the tolerance
    if (share > 1.0) rounded_tolerance_ = std::max(rounded_tolerance_, share * settings_.tolerance);
  }
}

void Integrator::update_weights(Dynamics& dynamics) {
  if (settings_.tolerance < RateRounding::k_least_tolerance)
    rate_rounding_.note_step(dynamics, t0_, y0_.data(), k0_, length_scale_, scratch_.data());
  const Layout& layout = dynamics.layout();
  const int m = dynamics.coordinate_count();
  const double tolerance = settings_.tolerance;
  const auto weigh = [&](int i) {
    const CoordinateScale& scale = layout.scales[i];
    const bool is_locked = layout.inverse_mass[i] == 0.0;
    double size = scale.is_place ? k_displacement_floor * length_scale_ : k_displacement_floor;
    // Coordinates of mechanisms: the error of an angle is weighted by the displacement that it causes, so that a moved point is as
    // accurate as a position.
    if (scale.reach > length_scale_) size *= length_scale_ / scale.reach;
    double displacement = std::abs(y0_[i] - layout.reference[i]);
    if (scale.reach > 0.0) displacement = std::min(displacement, 1.0); // displacement of a point by an angle is at most its reach
    weight_[i] = is_locked ? 0.0 : 1.0 / (tolerance * (size + displacement));
    weight_[m + i] = is_locked ? 0.0 : 1.0 / (tolerance * (rate_floor_ * size + std::abs(y0_[m + i])));
  };
  for (int i = 0; i < m; ++i) weigh(i);
  if (has_slip_scale0_) {
    const double share = slip_care_ * slip_share(settings_.division) * std::min(1.0, std::sqrt(k_slip_numbers / n_));
    for (int i = 0; i < m; ++i)
      if (weight_[m + i] > 0.0) weight_[m + i] = std::max(weight_[m + i], 1.0 / (share * slip_scale0_[i]));
  }
  // Inner states are displacements (of an elastic joint: m, m, rad) and get the accuracy of body positions.
  for (int i = 2 * m; i < n_ - 2; ++i)
    weight_[i] =
        1.0 / (tolerance * (k_displacement_floor * std::min(length_scale_, 1.0) + std::abs(y0_[i] - system_.initial_inner[i - 2 * m])));
  // Dissipated energy and work: errors are relative to the largest of the present energy, the energy converted so far, and the energy of
  // the absolute scales.
  const double floor_rate = rate_floor_ * k_displacement_floor * length_scale_;
  double energy = std::abs(y0_[n_ - 2]) + std::abs(y0_[n_ - 1]);
  const double* v = dynamics.cluster_rates(y0_.data());
  for (int k = 0; k < layout.cluster_count(); ++k, v += 3) {
    const Cluster& cluster = layout.clusters[k];
    energy += 0.5 * cluster.mass * (v[0] * v[0] + v[1] * v[1] + floor_rate * floor_rate) + 0.5 * cluster.inertia * v[2] * v[2];
  }
  weight_[n_ - 2] = weight_[n_ - 1] = energy > 0.0 ? 1.0 / (tolerance * energy) : 0.0;
  note_rounding();
}

double Integrator::error_norm(const double* error) const {
  const bool is_rounded = rate_rounding_.is_known();
  double sum = 0.0;
  for (int i = 0; i < n_; ++i) {
    double e = error[i] * weight_[i];
    if (is_rounded) e /= std::max(1.0, rate_rounding_.over_step(i, h_) * weight_[i]);
    sum += e * e;
  }
  return std::sqrt(sum / n_);
}

double Integrator::projected_error_norm(Dynamics& dynamics, double* error) const {
  const double all = error_norm(error);
  if (!dynamics.is_near_singular()) return all;
  dynamics.remove_constrained_error(error);
  return std::max(error_norm(error), k_turned_share * all);
}

// Compares the present forces with those of the new modes at the position after h with unchanged velocity, because a contact that has
// just closed presses harder the deeper it gets. Forces may change a velocity within the step by at most its own magnitude.
double Integrator::restrained_step(Dynamics& dynamics, double h) {
  constexpr int k_most_tries = 12;
  constexpr double k_most_shortened = 0.03;
  const int m = dynamics.coordinate_count();
  double* const y = scratch_.data();
  double* const f = y + n_;
  for (int attempt = 0; attempt < k_most_tries; ++attempt) {
    for (int i = 0; i < n_; ++i) y[i] = y0_[i] + h * k0_[i];
    const bool is_evaluated = try_evaluation(h, [&] { dynamics.evaluate(Request::stage, t0_ + h, y, f); });
    double turned = is_evaluated ? 0.0 : std::numeric_limits<double>::infinity();
    for (int i = m; i < 2 * m && is_evaluated; ++i)
      turned = std::max(turned, settings_.tolerance * weight_[i] * h * std::abs(f[i] - k0_[i]));
    if (turned <= 1.0) return attempt == 0 ? h : h / settings_.division;
    h *= std::isfinite(turned) ? std::max(k_most_shortened, 0.8 / std::sqrt(turned)) : k_most_shortened;
  }
  return h / settings_.division;
}

// Returns the length of the first step, s, from the norms of y, f and a difference of f (Hairer, Nørsett, Wanner, Solving ODEs I, II.4).
double Integrator::first_step(Dynamics& dynamics, int order, double h_max) {
  update_weights(dynamics);
  double* y = scratch_.data();
  double* f = y + n_;
  double* change = f + n_;
  constexpr double k_shorter = 0.1;
  for (int i = 0; i < n_; ++i) change[i] = i < dynamics.coordinate_count() ? y0_[i] - dynamics.layout().reference[i] : y0_[i];
  for (int i = 2 * dynamics.coordinate_count(); i < n_ - 2; ++i) change[i] -= system_.initial_inner[i - 2 * dynamics.coordinate_count()];
  const double size = error_norm(change) + 1.0 / settings_.tolerance * 1e-3;
  const double slope = error_norm(k0_);
  double h = slope > 0.0 ? 0.01 * size / slope : h_max;
  h = std::min(h, h_max);
  const auto evaluate = [&] {
    for (int i = 0; i < n_; ++i) y[i] = y0_[i] + h * k0_[i];
    dynamics.rates(t0_ + h, y, f);
  };
  while (!try_evaluation(h, evaluate)) h *= k_shorter;
  for (int i = 0; i < n_; ++i) change[i] = (f[i] - k0_[i]) / h;
  const double curvature = std::max(slope, error_norm(change));
  const double h1 = curvature > 0.0 ? portable::pow(0.01 / curvature, 1.0 / (order + 1)) : h_max;
  return std::min({100.0 * h, h1, h_max});
}

} // namespace steplap
