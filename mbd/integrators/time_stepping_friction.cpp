// Friction in a time step: rows, their responses, and the wrenches within the admissible sets.
#include "mbd/base/portable_math.h"
#include "mbd/integrators/time_stepping.h"
#include "mbd/system/row_gradient.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_sweeps = 2000;
constexpr int k_joint_sweeps = 10;  // after each of the first sweeps all sticking elements are solved together,
constexpr int k_sweeps_between = 8; // later, one sweep in this many is followed by an extrapolation of its change
constexpr double k_longest_stretch = 1e15;
constexpr int k_bisections = 60;
constexpr double k_settled = 1e-9; // relative change of an element's wrench; far below the error of the method
// If no wrench changes by more than this in a sweep, the wrenches are the exact solution for velocities that differ by this relative
// amount, which is also far below the error of the method.
constexpr double k_tolerated = 1e-6;
constexpr double k_small_share = 1e-3; // elements below this fraction of the largest wrench use that fraction as their scale
// Ratio of the mobility with joints and drives to that without them. Smaller values are rounding errors of zero.
constexpr double k_driven = 1e-12;
// Where drives alone determine the velocity: rounding error of the velocity relative to the terms it is a difference of; below it the
// element is at rest.
constexpr double k_rest = 1e-10;
constexpr double k_tolerances_at_rest = 10.0;
// Wrenches of elements that stick together: proximal point iterations with this regularisation. For dependent rows they converge to the
// (weighted) least of all solutions.
constexpr double k_proximal = 1e-10;
constexpr int k_proximal_steps = 4;
// Velocity that counts as rest, relative to the contribution of other elements: their wrenches are accurate to k_settled, or to this
// multiple of the last change. An element on the boundary of its set without a velocity sticks, since many distributions of a load lead
// there.
constexpr double k_rest_of_others = 1e-7, k_changes_at_rest = 10.0;
// Change of a wrench for computing the derivatives of bounds, relative to the element's capacity. If it is too large, it is reduced by the
// factor k_shorter, up to k_probes times.
constexpr double k_probe = 1e-2, k_shorter = 1e-2;
constexpr int k_probes = 6;
constexpr int k_sets_expected = 8; // capacity reserved for the sets of modes tried in a step
constexpr double k_held = 1e-6;    // relative residual of the velocities below which sticking together is possible

} // namespace

// Returns true if the element stuck before this step at the same contact point. Its anchor is then kept, with all that the element has
// computed for it.
bool TimeStepping::has_held(const FrictionState& friction, int f) const {
  return start_.friction[f].phase == FrictionPhase::stick && start_.friction[f].foot == friction.foot;
}

// Collects the elements with a nonzero admissible set, anchored at the present position. Their rows are forces here, not constraints.
void TimeStepping::collect_friction(Dynamics& dynamics, State& state) {
  parts_.clear();
  rows_ = 0;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionElement& element = *system_.frictions[f].friction;
    FrictionState& friction = state.friction[f];
    if (friction.phase == FrictionPhase::apart || element.never_slips()) continue;
    FrictionState before = friction; // a joint that sticks cannot separate, so the phase matters
    before.phase = start_.friction[f].phase;
    if (element.contact_point_event(dynamics.evaluation(), before) < 0.0) element.switch_contact_point(dynamics.evaluation(), friction);
    if (friction.phase == FrictionPhase::apart) continue;
    const RowSpec* rows = element.rows(friction);
    for (int r = 0; r < element.dimension() && !has_held(friction, f); ++r)
      if (rows[r].base >= 0) state.bases[rows[r].base].value = evaluate_row<false>(rows[r], dynamics.motion().data()).value;
    FrictionPart part;
    part.friction = f;
    part.has_slid = slid_before(f);
    part.first = rows_;
    part.dimension = element.dimension();
    parts_.push_back(part);
    rows_ += part.dimension;
  }
  wrench_.assign(rows_, 0.0);
  gradient_.resize(rows_);
}

// Computes the gradient of a friction row in the coordinates of the clusters.
void TimeStepping::load_row(Dynamics& dynamics, const RowSpec& spec, FrictionGradient& row) const {
  const Layout& layout = dynamics.layout();
  const std::vector<Motion<double>>& motion = dynamics.motion();
  const auto m = evaluate_row<false>(spec, motion.data());
  row = {};
  const int body[2] = {spec.a, spec.b};
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout.placements[body[side]];
    row.cluster[side] = place.cluster;
    if (place.cluster < 0) continue;
    const Motion<double>& k = motion[layout.clusters[place.cluster].motion];
    const Pair<double> off{motion[body[side]].x - k.x, motion[body[side]].y - k.y};
    put_gradient(m, side, (side == 0 ? m.lever_a : m.lever_b) + off, row.g[side]);
  }
  if (row.cluster[0] < 0 || row.cluster[0] != row.cluster[1]) return;
  for (int c = 0; c < 3; ++c) row.g[0][c] += row.g[1][c]; // both bodies belong to one cluster
  row.cluster[1] = -1;
}

// Computes the responses to unit forces along the friction rows, including the reactions of joints and drives.
void TimeStepping::respond(Dynamics& dynamics, double h) {
  const std::vector<double>& w = linearization_.inverse_mass();
  const auto n2 = static_cast<std::size_t>(2 * n_), rows = static_cast<std::size_t>(rows_);
  for (const FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    for (int i = 0; i < part.dimension; ++i) load_row(dynamics, specs[i], gradient_[part.first + i]);
  }
  matrix_.reserve(rows * rows); // for hold_together(), which may be needed for the first time late in a run
  for (auto* v : {&together_, &rest_}) v->reserve(rows);
  held_.reserve(rows);
  overload_.reserve(parts_.size());
  tried_.reserve(k_sets_expected * parts_.size());
  response_.resize(rows * n2);
  compliance_.assign(rows * rows, 0.0);
  rate_.assign(rows, 0.0);
  for (std::size_t r = 0; r < rows; ++r) {
    std::fill(right_.begin(), right_.begin() + n_, 0.0);
    const FrictionGradient& row = gradient_[r];
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3 && row.cluster[side] >= 0; ++c) {
        const int k = 3 * row.cluster[side] + c;
        right_[k] += w[k] * row.g[side][c];
      }
    stages_.solve_for_forces(right_.data(), &response_[r * n2]);
  }
  for (std::size_t i = 0; i < rows; ++i)
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3 && gradient_[i].cluster[side] >= 0; ++c) {
        const std::size_t k = n_ + 3 * gradient_[i].cluster[side] + c;
        for (std::size_t j = 0; j < rows; ++j) compliance_[i * rows + j] += gradient_[i].g[side][c] * response_[j * n2 + k];
      }
  for (FrictionPart& part : parts_) find_driven(part, h);
}

// Finds the directions in which joints and drives leave no mobility, so that no wrench changes the velocity.
void TimeStepping::find_driven(FrictionPart& part, double h) {
  const std::vector<double>& w = linearization_.inverse_mass();
  Mat3 scaled = Mat3::Identity();
  Vec3 scale = Vec3::Ones(); // mobility of the two bodies without joints
  for (int i = 0; i < part.dimension; ++i) {
    const FrictionGradient& row = gradient_[part.first + i];
    double own = 0.0;
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3 && row.cluster[side] >= 0; ++c) own += h * w[3 * row.cluster[side] + c] * row.g[side][c] * row.g[side][c];
    scale[i] = own > 0.0 ? std::sqrt(own) : 1.0;
  }
  for (int i = 0; i < part.dimension; ++i)
    for (int j = 0; j < part.dimension; ++j)
      scaled(i, j) = compliance_[static_cast<std::size_t>(part.first + i) * rows_ + part.first + j] / (scale[i] * scale[j]);
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

// Computes the rates of the rows without friction: those at the projected end of the step minus the responses to the wrenches.
void TimeStepping::free_rates(Dynamics& dynamics, double tolerance) {
  const Motion<double>* const motion = dynamics.motion().data();
  for (FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    double speed = 0.0;
    for (int i = 0; i < part.dimension; ++i) {
      const std::size_t r = part.first + i;
      rate_[r] = evaluate_row<false>(specs[i], motion).rate;
      for (int j = 0; j < rows_; ++j) rate_[r] -= compliance_[r * rows_ + j] * wrench_[j];
      for (const int body : {specs[i].a, specs[i].b})
        if (body != k_ground) speed = std::max({speed, portable::hypot(motion[body].vx, motion[body].vy), std::abs(motion[body].omega)});
    }
    part.noise = k_rest * speed + k_tolerances_at_rest * tolerance;
  }
}

// Returns the bound of a one-dimensional element at the evaluation `e`.
double TimeStepping::bound_of(const Evaluation& e, const FrictionPart& part, bool is_kinetic) const {
  const FrictionElement& element = *system_.frictions[part.friction].friction;
  const FrictionState& friction = e.friction[part.friction];
  if (!element.is_loaded(e, friction)) return 0.0;
  const double a[9] = {}, b[3] = {-1.0}; // the wrench is insufficient in any case, so it equals the bound
  return element.solve_block(e, friction, a, b, is_kinetic).wrench[0];
}

// Linearises bounds as functions of the wrenches at their present values. Normal forces end at zero, where they no longer depend on
// wrenches: an element whose wrench has reduced its own normal force to zero starts again with zero wrench.
void TimeStepping::couple_bounds(Dynamics& dynamics, double t1, double tolerance) {
  const bool is_first = !is_coupled_;
  is_coupled_ = true;
  bool is_moved = false;
  for (const FrictionPart& part : parts_) {
    double& wrench = wrench_[part.first];
    if (part.dimension != 1 || wrench == 0.0) continue;
    if (!is_first && bound_of(dynamics.evaluation(), part, false) > 0.0) continue;
    wrench = 0.0; // the repetitions so far may have led to any value
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

// Computes the derivatives of all bounds by a wrench of element `by`, as a difference small enough that no bound becomes zero.
void TimeStepping::find_slope(Dynamics& dynamics, double t1, const FrictionPart& by) {
  double size = k_probe * by.bound;
  for (int attempt = 0; attempt < k_probes; ++attempt, size *= k_shorter) {
    std::copy(y1_.begin(), y1_.end(), probe_.begin());
    const double* const response = &response_[static_cast<std::size_t>(by.first) * 2 * n_];
    for (int i = 0; i < 2 * n_; ++i) probe_[i] += size * response[i];
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

// Solves a one-dimensional element with bound B(w) = bound + slope w: it sticks if |w| ≤ B(w) stops it, otherwise it slides in either
// direction with w = ∓B(w) against the rate a w + b. If several solutions exist (Painlevé's paradox) it sticks.
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

// Solves one element for the present wrenches of the others.
BlockSolution TimeStepping::solve_part(const Evaluation& e, const FrictionPart& part) const {
  const FrictionElement& element = *system_.frictions[part.friction].friction;
  const FrictionState& friction = e.friction[part.friction];
  const int d = part.dimension;
  double a[9] = {}, b[3] = {};
  for (int i = 0; i < d; ++i) {
    const std::size_t row = part.first + i;
    const double* const c = &compliance_[row * rows_];
    b[i] = rate_[row];
    for (int j = 0; j < rows_; ++j)
      if (j < part.first || j >= part.first + d) b[i] += c[j] * wrench_[j];
    for (int j = 0; j < d; ++j) a[i * d + j] = c[part.first + j];
  }
  if (part.is_driven && d == 1) {
    if (std::abs(b[0]) <= part.noise) return {}; // the wrench is undetermined, as the drive carries it: zero
    a[0] = 1e-30 * std::abs(b[0]);               // wrenches have almost no effect: it slides
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

// Returns a size that is comparable for forces and moments: the square root of the energy that the wrench alone would give.
double TimeStepping::size_of(const FrictionPart& part, const double* wrench) const {
  double size = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    const std::size_t r = part.first + i;
    size = std::max(size, std::abs(wrench[r]) * std::sqrt(std::max(0.0, compliance_[r * rows_ + r])));
  }
  return size;
}

// Returns the largest wrench, or the bound of a one-dimensional element if that is larger. Otherwise the zero friction force of a freely
// rolling wheel would never converge, because its rounding errors are large relative to it.
double TimeStepping::largest_size(const Evaluation& e) const {
  double size = 0.0;
  for (const FrictionPart& part : parts_) {
    size = std::max(size, size_of(part, wrench_.data()));
    if (part.dimension != 1) continue;
    const double bound = bound_of(e, part, false), c = compliance_[static_cast<std::size_t>(part.first) * rows_ + part.first];
    size = std::max(size, bound * std::sqrt(std::max(0.0, c)));
  }
  return size;
}

// Returns the change of an element's wrench relative to its own size or to a small fraction of the largest wrench.
double TimeStepping::change_of(const FrictionPart& part, const double* before, double size) const {
  double change = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    const std::size_t r = part.first + i;
    const double c = std::abs(wrench_[r] - before[i]) * std::sqrt(std::max(0.0, compliance_[r * rows_ + r]));
    if (!(c <= change)) change = c;
  }
  const double own = std::max(size_of(part, wrench_.data()), k_small_share * size);
  return change > 0.0 || std::isnan(change) ? change / own : 0.0;
}

// Solves each element once. Returns the largest change; `worst` is its element.
double TimeStepping::sweep(Dynamics& dynamics, int& worst) {
  const Evaluation& e = dynamics.evaluation();
  last_ = wrench_;
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

// Solves for the wrenches of all sticking elements together, with those of slipping ones fixed. If the set of sticking elements is right,
// the next sweep changes nothing. If no wrenches can stop all of them, nothing is changed.
void TimeStepping::hold_together() {
  held_.clear();
  for (const FrictionPart& part : parts_)
    for (int i = 0; part.block.sticks && !part.is_driven && i < part.dimension; ++i) held_.push_back(part.first + i);
  if (held_.empty() || !hold_rows()) return;
  for (std::size_t i = 0; i < held_.size(); ++i) wrench_[held_[i]] = together_[i];
}

// Computes the wrenches together_ that stop the rows held_, the least ones if there are many. Returns false if there are none.
bool TimeStepping::hold_rows() { return factor_held(k_proximal) && solve_held(k_proximal_steps) <= k_held; }

// Computes L Lᵀ of the symmetric part of the compliance of the rows held_, with its diagonal increased by the fraction `proximal`. Returns
// false if it is not positive definite.
bool TimeStepping::factor_held(double proximal) {
  const std::size_t n = held_.size();
  const auto c = [&](std::size_t i, std::size_t j) { return compliance_[static_cast<std::size_t>(held_[i]) * rows_ + held_[j]]; };
  matrix_.resize(n * n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? c(i, i) * (1.0 + proximal) : 0.5 * (c(i, j) + c(j, i));
      for (std::size_t k = 0; k < j; ++k) sum -= matrix_[i * n + k] * matrix_[j * n + k];
      if (i == j && !(sum > 0.0)) return false;
      matrix_[i * n + j] = i == j ? std::sqrt(sum) : sum / matrix_[j * n + j];
    }
  }
  return true;
}

// Computes the wrenches together_ by the given number of proximal iterations with the factors of factor_held(); other wrenches are fixed.
// Returns the remaining velocity of the rows relative to that without these wrenches.
double TimeStepping::solve_held(int steps) {
  const std::size_t n = held_.size();
  together_.assign(n, 0.0);
  rest_.resize(n);
  double wanted = 0.0, left = 0.0;
  for (int step = 0; step <= steps; ++step) {
    left = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double* const row = &compliance_[static_cast<std::size_t>(held_[i]) * rows_];
      double sum = -rate_[held_[i]];
      for (int j = 0; j < rows_; ++j) sum -= row[j] * wrench_[j];
      for (std::size_t j = 0; j < n; ++j) sum -= row[held_[j]] * (together_[j] - wrench_[held_[j]]);
      rest_[i] = sum;
      left = std::max(left, std::abs(sum) / std::sqrt(row[held_[i]]));
    }
    if (step == 0) wanted = left;
    if (step == steps) break;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) rest_[i] -= matrix_[i * n + k] * rest_[k];
      rest_[i] /= matrix_[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) rest_[i] -= matrix_[k * n + i] * rest_[k];
      rest_[i] /= matrix_[i * n + i];
      together_[i] += rest_[i];
    }
  }
  return wanted > 0.0 ? left / wanted : 0.0;
}

// Returns true if all elements can carry the wrenches before the last sweep plus `share` of its change.
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
    for (int i = 0; i < d; ++i) { // the nearest admissible wrench is w itself
      a[i * d + i] = compliance_[static_cast<std::size_t>(part.first + i) * rows_ + part.first + i];
      b[i] = -a[i * d + i] * w[i];
    }
    if (!element.solve_block(e, e.friction[part.friction], a, b, part.is_kinetic).sticks) return false;
  }
  return true;
}

// Extrapolates the change of the last sweep as far as the energy decreases and all wrenches remain admissible. With nearly dependent rows
// (two feet of a slightly rotated box) the energy is almost constant for some exchange of load between them, and plain sweeps converge very
// slowly.
void TimeStepping::stretch(const Evaluation& e) {
  double slope = 0.0, curvature = 0.0;
  for (int i = 0; i < rows_; ++i) {
    const double s = wrench_[i] - last_[i], *const c = &compliance_[static_cast<std::size_t>(i) * rows_];
    if (s == 0.0) continue;
    slope += s * rate_[i];
    for (int j = 0; j < rows_; ++j) {
      slope += s * c[j] * last_[j];
      curvature += s * c[j] * (wrench_[j] - last_[j]);
    }
  }
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

// Makes elements stick that are on the boundary of their set with a velocity no larger than the remaining changes of the others.
void TimeStepping::stop_at_rest(double change) {
  const double share = std::max(k_rest_of_others, k_changes_at_rest * change);
  for (FrictionPart& part : parts_) {
    if (part.block.sticks || part.is_driven) continue;
    double velocity = 0.0, others = 0.0;
    for (int i = 0; i < part.dimension; ++i) {
      const std::size_t r = part.first + i;
      const double* const c = &compliance_[r * rows_];
      double sum = rate_[r], size = 0.0;
      for (int j = 0; j < rows_; ++j) {
        sum += c[j] * wrench_[j];
        if (j < part.first || j >= part.first + part.dimension) size += std::abs(c[j] * wrench_[j]);
      }
      velocity = std::max(velocity, std::abs(sum) / std::sqrt(c[r]));
      others = std::max(others, size / std::sqrt(c[r]));
    }
    part.block.sticks = velocity <= share * others;
  }
}

// Block Gauss–Seidel iteration: solves each element for the present wrenches of the others, with the present choice of static or kinetic
// coefficients.
TimeStepping::Trouble TimeStepping::settle_wrenches(Dynamics& dynamics, double& change) {
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
