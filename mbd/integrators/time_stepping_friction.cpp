// Friction in a time step: gradients and compliance of the rows, and the wrenches within the admissible sets.
#include "mbd/base/portable_math.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/system/bounded_friction.h"
#include "mbd/system/row_gradient.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_sweeps = 2000;
constexpr int k_joint_sweeps = 10;  // after each of the first sweeps all sticking elements are solved simultaneously
constexpr int k_sweeps_between = 8; // later, after every eighth sweep its change is extrapolated
constexpr double k_longest_stretch = 1e15;
constexpr int k_bisections = 60;
constexpr double k_settled = 1e-9; // convergence: relative change of an element's wrench; far below the error of the method
// If no wrench changes by more than this in a sweep, the wrenches solve exactly a problem whose velocities differ by this relative
// amount, also far below the error of the method.
constexpr double k_tolerated = 1e-6;
constexpr double k_small_share = 1e-3; // smallest scale of relative changes, as fraction of the largest wrench
// A direction is driven if its mobility with joints and drives, relative to that without them, is below this rounding error.
constexpr double k_driven = 1e-12;
// In a driven direction the velocity is a difference of larger terms. It counts as zero below this fraction of them.
constexpr double k_rest = 1e-10;
constexpr double k_tolerances_at_rest = 10.0;
// Proximal-point iteration for the wrenches of elements that stick together: regularisation and number of steps. For dependent rows it
// converges to the (weighted) least of all solutions.
constexpr double k_proximal = 1e-10;
constexpr int k_proximal_steps = 4;
// Velocity that counts as rest, relative to the contribution of the other elements' wrenches: at least k_rest_of_others, and
// k_changes_at_rest times the last change of the wrenches. An element on the boundary of its set with such a velocity sticks, because a
// load can be distributed in many ways, and some of them reach the boundary.
constexpr double k_unsymmetric = 10.0; // allowance for springs and dampers that make the compliance unsymmetric
constexpr double k_rest_of_others = 1e-7, k_changes_at_rest = 10.0;
// Change of a wrench for finite differences of bounds, relative to the element's capacity. If a bound becomes zero the change is reduced
// by the factor k_shorter, up to k_probes times.
constexpr double k_probe = 1e-2, k_shorter = 1e-2;
constexpr int k_probes = 6;
constexpr int k_sets_expected = 8;   // capacity reserved for the sets of coefficients tried in a step
constexpr double k_rounding = 1e-14; // relative residual below which proximal iterations end
constexpr double k_held = 1e-6;      // relative residual of the velocities below which the elements can stick together

} // namespace

// Returns true if the element already stuck before this step, at the same contact point. Its anchor and the data that the element has
// cached for it are then kept.
bool TimeStepping::has_held(const FrictionState& friction, int f) const {
  return start_.friction[f].phase == FrictionPhase::stick && start_.friction[f].foot == friction.foot;
}

// Collects the elements that may act in this part, with their anchors at the present position. Their rows carry forces here and are not
// constraints.
void TimeStepping::collect_friction(Dynamics& dynamics, State& state) {
  parts_.clear();
  rows_ = 0;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionElement& element = *system_.frictions[f].friction;
    FrictionState& friction = state.friction[f];
    if (friction.phase == FrictionPhase::apart || element.never_slips()) continue;
    FrictionState before = friction; // phase at the start of the part: a joint that sticks cannot separate
    before.phase = start_.friction[f].phase;
    if (element.contact_point_event(dynamics.evaluation(), before) < 0.0) element.switch_contact_point(dynamics.evaluation(), friction);
    if (friction.phase == FrictionPhase::apart) continue;
    const RowSpec* rows = element.rows(friction);
    for (int r = 0; r < element.dimension() && !has_held(friction, f); ++r)
      if (rows[r].base >= 0) state.bases[rows[r].base].value = evaluate_row<false>(rows[r], dynamics.motion().data()).value;
    FrictionPart part;
    part.friction = f;
    part.has_slid = slid_before(f);
    part.has_landed = start_.friction[f].phase == FrictionPhase::free;
    for (int r = 0; r < element.dimension() && part.has_landed; ++r)
      part.landing_rate[r] = evaluate_row<false>(rows[r], dynamics.motion().data()).rate;
    part.first = rows_;
    part.dimension = element.dimension();
    parts_.push_back(part);
    rows_ += part.dimension;
  }
  wrench_.assign(rows_, 0.0);
  force_rows_.resize(rows_);
}

// Computes the gradient of a friction row in the free coordinates of the clusters.
void TimeStepping::load_row(Dynamics& dynamics, const RowSpec& spec, ForceRow& row) const {
  const Layout& layout = dynamics.layout();
  const std::vector<Motion<double>>& motion = dynamics.motion();
  const std::vector<double>& w = linearization_.inverse_mass();
  const auto m = evaluate_row<false>(spec, motion.data());
  const int body[2] = {spec.a, spec.b};
  row.count = 0;
  const bool is_swapped = layout.placements[spec.b].cluster < layout.placements[spec.a].cluster;
  for (const int side : {is_swapped ? 1 : 0, is_swapped ? 0 : 1}) { // clusters in ascending order, so that coordinates are ascending
    const int cluster = layout.placements[body[side]].cluster;
    if (cluster < 0) continue;
    const Motion<double>& k = motion[layout.clusters[cluster].motion];
    const Pair<double> off{motion[body[side]].x - k.x, motion[body[side]].y - k.y};
    double g[3];
    put_gradient(m, side, (side == 0 ? m.lever_a : m.lever_b) + off, g);
    for (int c = 0; c < 3; ++c) {
      const int coordinate = 3 * cluster + c;
      if (!(w[coordinate] > 0.0)) continue;
      int* const end = row.coordinate + row.count;
      const auto at = std::find(row.coordinate, end, coordinate) - row.coordinate; // both bodies may belong to one cluster
      if (at == row.count) row.gradient[at] = 0.0;
      row.count = std::max(row.count, static_cast<int>(at) + 1);
      row.coordinate[at] = coordinate;
      row.gradient[at] += g[c];
    }
  }
}

// Computes the compliance along the friction rows, including the reactions of joints and drives.
void TimeStepping::respond(Dynamics& dynamics, double h) {
  for (const FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    for (int i = 0; i < part.dimension; ++i) load_row(dynamics, specs[i], force_rows_[part.first + i]);
  }
  const bool is_larger = static_cast<int>(is_held_.size()) < rows_;
  for (auto* v : {&together_, &rest_, &softness_}) v->assign(rows_, 0.0);
  is_held_.resize(rows_);
  overload_.reserve(parts_.size());
  tried_.reserve(k_sets_expected * parts_.size());
  rate_.assign(rows_, 0.0);
  compliance_.set(stages_, force_rows_);
  for (FrictionPart& part : parts_) {
    for (int i = 0; i < part.dimension; ++i)
      for (int j = 0; j < part.dimension; ++j) part.own[i * part.dimension + j] = compliance_.between(part.first + i, part.first + j);
    find_driven(part, h);
  }
  if (!is_larger) return; // otherwise allocates the memory of hold_rows() now, since its first use may be late in a run
  hold([](const FrictionPart&) { return true; });
  (void)factor_held(k_proximal);
}

// Finds the directions in which joints and drives leave no mobility, so that wrenches cannot change the velocity.
void TimeStepping::find_driven(FrictionPart& part, double h) {
  const std::vector<double>& w = linearization_.inverse_mass();
  Mat3 scaled = Mat3::Identity();
  Vec3 scale = Vec3::Ones(); // square root of the mobility of the two bodies without joints
  for (int i = 0; i < part.dimension; ++i) {
    const ForceRow& row = force_rows_[part.first + i];
    double own = 0.0;
    for (int c = 0; c < row.count; ++c) own += h * w[row.coordinate[c]] * row.gradient[c] * row.gradient[c];
    scale[i] = own > 0.0 ? std::sqrt(own) : 1.0;
  }
  for (int i = 0; i < part.dimension; ++i)
    for (int j = 0; j < part.dimension; ++j) scaled(i, j) = part.own[i * part.dimension + j] / (scale[i] * scale[j]);
  if (part.dimension == 1) {
    part.is_driven = !(scaled(0, 0) > k_driven);
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(0.5 * (scaled + scaled.transpose()));
  part.is_driven = !(eigen.eigenvalues()[0] > k_driven);
  if (!part.is_driven) return;
  Mat3 range = Mat3::Zero();
  part.mobility.setZero();
  for (int i = 0; i < 3; ++i) {
    if (!(eigen.eigenvalues()[i] > k_driven)) continue;
    const Mat3 axis = eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
    part.mobility += eigen.eigenvalues()[i] * axis;
    range += axis;
  }
  part.mobility = scale.asDiagonal() * part.mobility * scale.asDiagonal();
  part.free = scale.asDiagonal() * range * scale.cwiseInverse().asDiagonal();
}

// Computes the rates of the rows without friction: the rates at the projected end of the step minus the contribution of the wrenches.
void TimeStepping::rates_without_friction(Dynamics& dynamics, double tolerance) {
  const Motion<double>* const motion = dynamics.motion().data();
  compliance_.apply(wrench_);
  for (FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    double speed = 0.0;
    for (int i = 0; i < part.dimension; ++i) {
      const std::size_t r = part.first + i;
      rate_[r] = evaluate_row<false>(specs[i], motion).rate - compliance_.rate(static_cast<int>(r));
      for (const int body : {specs[i].a, specs[i].b})
        if (body != k_ground) speed = std::max({speed, portable::hypot(motion[body].vx, motion[body].vy), std::abs(motion[body].omega)});
    }
    part.noise = k_rest * speed + k_tolerances_at_rest * tolerance;
  }
}

// Returns the bound, N or N m, of a one-dimensional element at the evaluation `e`.
double TimeStepping::bound_of(const Evaluation& e, const FrictionPart& part, bool is_kinetic) const {
  const FrictionElement& element = *system_.frictions[part.friction].friction;
  const FrictionState& friction = e.friction[part.friction];
  if (!element.is_loaded(e, friction)) return 0.0;
  return system_.frictions[part.friction].bounded->bounds(e, friction, is_kinetic).high;
}

// Linearises the bounds as functions of the wrenches about their present values. Where the normal force has become zero, bounds no
// longer depend on wrenches; an element that has reduced its own normal force to zero therefore starts again from zero wrench.
void TimeStepping::couple_bounds(Dynamics& dynamics, double t1, double tolerance) {
  const bool is_first = !is_coupled_;
  is_coupled_ = true;
  bool is_moved = false;
  for (const FrictionPart& part : parts_) {
    double& wrench = wrench_[part.first];
    if (part.dimension != 1 || wrench == 0.0) continue;
    if (!is_first && bound_of(dynamics.evaluation(), part, false) > 0.0) continue;
    wrench = 0.0; // at the first call every wrench is reset, because the diverging passes before may have led anywhere
    is_moved = true;
  }
  if (is_moved) move(dynamics, t1, tolerance);
  bound_at_ = wrench_;
  bound_by_.assign(static_cast<std::size_t>(rows_) * rows_, 0.0);
  for (FrictionPart& part : parts_) {
    if (part.dimension != 1) continue;
    part.bound = bound_of(dynamics.evaluation(), part, false);
    part.kinetic_share = part.bound > 0.0 ? bound_of(dynamics.evaluation(), part, true) / part.bound : 1.0;
  }
  for (const FrictionPart& part : parts_)
    if (part.dimension == 1 && part.bound > 0.0) find_slope(dynamics, t1, part);
  evaluate(dynamics, t1, y1_.data());
}

// Computes the derivatives of all bounds with respect to the wrench of element `by`, by a difference small enough that no bound becomes
// zero.
void TimeStepping::find_slope(Dynamics& dynamics, double t1, const FrictionPart& by) {
  double size = k_probe * by.bound;
  rest_.assign(rows_, 0.0);
  rest_[by.first] = 1.0;
  compliance_.apply(rest_);
  compliance_.response(response_.data());
  for (int attempt = 0; attempt < k_probes; ++attempt, size *= k_shorter) {
    std::copy(y1_.begin(), y1_.end(), probe_.begin());
    for (int i = 0; i < 2 * n_; ++i) probe_[i] += size * response_[i];
    evaluate(dynamics, t1, probe_.data());
    bool is_short = true;
    for (const FrictionPart& part : parts_) {
      if (part.dimension != 1 || !(part.bound > 0.0)) continue;
      const double bound = bound_of(dynamics.evaluation(), part, false);
      is_short = is_short && bound > 0.0;
      bound_by_[static_cast<std::size_t>(part.first) * rows_ + by.first] = (bound - part.bound) / size;
    }
    if (is_short) return;
  }
}

// Solves a one-dimensional element with the linear bound B(w) = bound + slope w and the rate a w + b. It sticks if the wrench that stops
// it has |w| ≤ B(w). Otherwise it slides in either direction, with w = ∓B(w) against the rate. If several solutions exist (Painlevé's
// paradox) it sticks.
BlockSolution TimeStepping::solve_coupled(const FrictionPart& part, double a, double b) const {
  const std::size_t row = part.first;
  const double* const by = &bound_by_[row * rows_];
  double bound = part.bound - by[row] * bound_at_[row], slope = by[row];
  for (int j = 0; j < rows_; ++j)
    if (j != part.first) bound += by[j] * (wrench_[j] - bound_at_[j]);
  if (part.is_kinetic) {
    bound *= part.kinetic_share;
    slope *= part.kinetic_share;
  }
  BlockSolution block;
  const double held = a > 0.0 ? -b / a : 0.0;
  block.sticks = a > 0.0 && std::abs(held) <= bound + slope * held;
  block.wrench[0] = held;
  if (block.sticks) return block;
  double least = std::numeric_limits<double>::infinity();
  for (const double sign : {1.0, -1.0}) { // direction of slip
    const double against = 1.0 + sign * slope;
    const double wrench = bound > 0.0 && against > 0.0 ? -sign * bound / against : 0.0;
    const double wrong = std::max(0.0, -sign * (a * wrench + b)) + (bound > 0.0 && against <= 0.0 ? std::abs(b) : 0.0);
    if (wrong >= least) continue;
    least = wrong;
    block.wrench[0] = wrench;
    block.direction[0] = sign;
  }
  return block;
}

// Solves one element for the present wrenches of the others, which compliance_ contains.
BlockSolution TimeStepping::solve_part(const Evaluation& e, const FrictionPart& part) const {
  const FrictionElement& element = *system_.frictions[part.friction].friction;
  const FrictionState& friction = e.friction[part.friction];
  const int d = part.dimension;
  double a[9], b[3] = {};
  std::copy(part.own, part.own + 9, a);
  for (int i = 0; i < d; ++i) {
    b[i] = rate_[part.first + i] + compliance_.rate(part.first + i);
    for (int j = 0; j < d; ++j) b[i] -= a[i * d + j] * wrench_[part.first + j];
  }
  if (part.is_driven && d == 1) {
    if (std::abs(b[0]) <= part.noise) return {}; // at rest by its drive: the wrench is undetermined and set to zero
    a[0] = 1e-30 * std::abs(b[0]);               // tiny mobility: the solution is sliding
  } else if (part.is_driven) {
    Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> block(a);
    Eigen::Map<Vec3> rate(b);
    block = part.mobility;
    const Vec3 moved = part.free * rate;
    if ((rate - moved).cwiseAbs().maxCoeff() <= part.noise) rate = moved;
  }
  if (is_coupled_ && d == 1) return solve_coupled(part, part.is_driven ? 0.0 : a[0], b[0]);
  return element.solve_block(e, friction, a, b, part.is_kinetic);
}

// Returns the magnitude of a wrench in units common to forces and moments: the square root of the energy that the wrench alone would
// cause.
double TimeStepping::size_of(const FrictionPart& part, const double* wrench) const {
  double size = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    size = std::max(size, std::abs(wrench[part.first + i]) * std::sqrt(std::max(0.0, part.compliance(i))));
  }
  return size;
}

// Returns the largest wrench or bound of a one-dimensional element, as size_of(). Without the bounds the zero friction force of a freely
// rolling wheel would never converge, because its changes would be compared with its own rounding error.
double TimeStepping::largest_size(const Evaluation& e) const {
  double size = 0.0;
  for (const FrictionPart& part : parts_) {
    size = std::max(size, size_of(part, wrench_.data()));
    if (part.dimension != 1) continue;
    size = std::max(size, bound_of(e, part, false) * std::sqrt(std::max(0.0, part.compliance(0))));
  }
  return size;
}

// Returns the change of an element's wrench relative to its own magnitude or to a small fraction of `size`, the largest one.
double TimeStepping::change_of(const FrictionPart& part, const double* before, double size) const {
  double change = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    const double c = std::abs(wrench_[part.first + i] - before[i]) * std::sqrt(std::max(0.0, part.compliance(i)));
    if (!(c <= change)) change = c;
  }
  const double own = std::max(size_of(part, wrench_.data()), k_small_share * size);
  return change > 0.0 || std::isnan(change) ? change / own : 0.0;
}

// Solves each element once. Returns the largest relative change of a wrench; `worst` is the friction element with this change.
double TimeStepping::sweep(Dynamics& dynamics, int& worst) {
  const Evaluation& e = dynamics.evaluation();
  last_ = wrench_;
  compliance_.apply(wrench_);
  double largest = 0.0, size = largest_size(e);
  for (FrictionPart& part : parts_) {
    BlockSolution block;
    block.sticks = false;
    part.is_loaded = system_.frictions[part.friction].friction->is_loaded(e, e.friction[part.friction]);
    if (part.is_loaded) block = solve_part(e, part);
    double* const wrench = &wrench_[part.first];
    double before[3] = {0, 0, 0};
    std::copy(wrench, wrench + part.dimension, before);
    std::copy(block.wrench, block.wrench + part.dimension, wrench);
    for (int i = 0; i < part.dimension; ++i) compliance_.add(part.first + i, wrench[i] - before[i]);
    part.block = block;
    size = std::max(size, size_of(part, wrench_.data()));
    const double change = change_of(part, before, size);
    if (!(change <= largest)) {
      largest = change;
      worst = part.friction;
    }
  }
  return largest;
}

// Solves for the wrenches of all sticking elements simultaneously, with those of slipping elements fixed. If the set of sticking
// elements is right, the next sweep changes nothing. If no wrenches can stop all of them, wrench_ is unchanged.
void TimeStepping::hold_together() {
  hold([](const FrictionPart& part) { return part.block.sticks; });
  if (hold_rows()) wrench_ = together_;
}

// Computes the wrenches together_ that stop the held rows (the least ones if they are not unique); other rows keep theirs. Returns false
// if no wrenches do.
bool TimeStepping::hold_rows() { return factor_held(k_proximal) && solve_held(k_proximal_steps) <= k_held; }

// Factorises the system of the held rows, with their compliance increased by the fraction `proximal`. Returns false if no row is held,
// or if the matrix is singular.
bool TimeStepping::factor_held(double proximal) {
  together_ = wrench_;
  if (std::find(is_held_.begin(), is_held_.end(), 1) == is_held_.end()) return false;
  bool is_new = false; // softness_ differs for held and free rows, so it shows whether the factors are valid; it is zero without factors
  for (const FrictionPart& part : parts_)
    for (int i = 0; i < part.dimension; ++i) {
      const int r = part.first + i;
      const double compliance = part.compliance(i) > 0.0 ? part.compliance(i) : 1.0;
      const double softness = is_held_[r] != 0 ? proximal * compliance : compliance;
      is_new = is_new || softness_[r] != softness;
      softness_[r] = softness;
    }
  if (!is_new || stages_.factor_held(force_rows_, is_held_, softness_)) return true;
  softness_.assign(rows_, 0.0);
  return false;
}

// Computes the wrenches together_ by up to `steps` proximal iterations with the factors of factor_held(). Returns the remaining velocity
// of the held rows relative to that without their wrenches.
double TimeStepping::solve_held(int steps) {
  double wanted = 0.0, left = 0.0;
  for (int r = 0; r < rows_; ++r)
    if (is_held_[r] != 0) together_[r] = 0.0;
  for (int step = 0; step <= steps; ++step) {
    left = 0.0;
    compliance_.apply(together_);
    for (const FrictionPart& part : parts_)
      for (int i = 0; i < part.dimension; ++i) {
        const int r = part.first + i;
        rest_[r] = is_held_[r] != 0 ? -rate_[r] - compliance_.rate(r) : 0.0;
        if (is_held_[r] != 0) left = std::max(left, std::abs(rest_[r]) / std::sqrt(part.compliance(i)));
      }
    if (step == 0) wanted = left;
    if (step == steps || left <= k_rounding * wanted) break;
    stages_.solve_held(rest_);
    for (int r = 0; r < rows_; ++r) together_[r] += rest_[r];
  }
  return wanted > 0.0 ? left / wanted : 0.0;
}

// Returns true if the wrenches before the last sweep plus `share` of its change are admissible for all elements.
bool TimeStepping::bears(const Evaluation& e, double share) const {
  for (const FrictionPart& part : parts_) {
    const FrictionElement& element = *system_.frictions[part.friction].friction;
    const int d = part.dimension;
    double w[3] = {}, a[9] = {}, b[3] = {};
    bool is_moved = false;
    for (int i = 0; i < d; ++i) {
      const double change = wrench_[part.first + i] - last_[part.first + i];
      w[i] = last_[part.first + i] + share * change;
      is_moved = is_moved || change != 0.0;
    }
    if (!is_moved) continue;
    for (int i = 0; i < d; ++i) { // unit compliance: the solution is the admissible wrench nearest to w, which is w itself if admissible
      a[i * d + i] = part.compliance(i);
      b[i] = -a[i * d + i] * w[i];
    }
    if (!element.solve_block(e, e.friction[part.friction], a, b, part.is_kinetic).sticks) return false;
  }
  return true;
}

// Extrapolates the change of the last sweep as far as the energy decreases and all wrenches remain admissible. With nearly dependent
// rows (two feet of a slightly rotated box) the energy hardly changes when load moves from one to the other, and plain sweeps converge
// very slowly.
void TimeStepping::stretch(const Evaluation& e) {
  double slope = 0.0, curvature = 0.0;
  const auto add_power = [&](const std::vector<double>& wrench, double sign) {
    compliance_.apply(wrench);
    for (int i = 0; i < rows_; ++i) {
      const double change = wrench_[i] - last_[i], rate = compliance_.rate(i);
      slope += sign < 0.0 ? change * (rate_[i] + rate) : 0.0;
      curvature += sign * change * rate;
    }
  };
  add_power(last_, -1.0);
  add_power(wrench_, 1.0);
  if (!(slope < 0.0)) return;
  const double best = slope < -k_longest_stretch * curvature ? k_longest_stretch : -slope / curvature;
  double share = 1.0, beyond = 2.0;
  for (; share < best && bears(e, std::min(beyond, best)); beyond *= 2.0) share = std::min(beyond, best);
  if (share < best)
    for (int i = 0; i < k_bisections; ++i) {
      const double middle = 0.5 * (share + beyond);
      (bears(e, middle) ? share : beyond) = middle;
    }
  for (int i = 0; i < rows_; ++i) wrench_[i] = last_[i] + share * (wrench_[i] - last_[i]);
}

// Returns the sum of the magnitudes of the contributions of all other elements to the rate of an element.
double TimeStepping::effect_of_others(const FrictionPart& part) const {
  double effect = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    double sum = 0.0;
    for (int j = 0; j < rows_; ++j)
      if ((j < part.first || j >= part.first + part.dimension) && wrench_[j] != 0.0)
        sum += std::abs(compliance_.between(part.first + i, j) * wrench_[j]);
    effect = std::max(effect, sum / std::sqrt(part.compliance(i)));
  }
  return effect;
}

// Sets elements to sticking that are on the boundary of their set with a velocity no larger than the effect of the remaining changes of
// the others.
void TimeStepping::stop_at_rest(double change) {
  const double share = std::max(k_rest_of_others, k_changes_at_rest * change);
  compliance_.apply(wrench_);
  // |C_ij| ≤ √(C_ii C_jj) for symmetric C, which limits the effect of others on any element. k_unsymmetric allows for a C that is only
  // nearly symmetric.
  double most = 0.0;
  for (const FrictionPart& part : parts_)
    for (int i = 0; i < part.dimension; ++i) most += std::abs(wrench_[part.first + i]) * std::sqrt(std::max(0.0, part.compliance(i)));
  most *= k_unsymmetric;
  for (FrictionPart& part : parts_) {
    if (part.block.sticks || part.is_driven) continue;
    double velocity = 0.0;
    for (int i = 0; i < part.dimension; ++i) {
      const int r = part.first + i;
      velocity = std::max(velocity, std::abs(rate_[r] + compliance_.rate(r)) / std::sqrt(part.compliance(i)));
    }
    part.block.sticks = velocity <= share * most && velocity <= share * effect_of_others(part);
  }
}

// Block Gauss–Seidel iteration: solves each element for the present wrenches of the others, with fixed static or kinetic coefficients.
TimeStepping::StepFailure TimeStepping::settle_wrenches(Dynamics& dynamics, double& change) {
  int worst = 0;
  for (int i = 0; i < k_max_sweeps; ++i) {
    change = sweep(dynamics, worst);
    if (change <= k_settled) break;
    if (i < k_joint_sweeps) hold_together();
    else if (!is_coupled_ && i % k_sweeps_between == 0) stretch(dynamics.evaluation());
  }
  if (!(change <= k_tolerated)) return {"friction", system_.frictions[worst].element, change, " of its force in the last of 2000 sweeps"};
  stop_at_rest(change);
  return {};
}

} // namespace steplap
