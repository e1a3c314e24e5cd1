// Friction in a time step: its rows, what wrenches along them do, and which of them the elements
// bear.
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
constexpr int k_joint_sweeps = 10;  // the first sweeps are followed by a common solution of all that stick,
constexpr int k_sweeps_between = 8; // one in so many by a stretch of what it changed
constexpr double k_longest_stretch = 1e15;
constexpr int k_bisections = 60;
constexpr double k_settled = 1e-9; // change of a wrench, of the element's own: far below the method's error
// The wrenches of a sweep that changed none by more solve the problem exactly for free velocities
// that differ from the true ones by what those changes do, as much relatively: that is far below
// the method's error, too.
constexpr double k_tolerated = 1e-6;
constexpr double k_small_share = 1e-3; // elements with less than this of the largest wrench count as having that
// Mobility that joints and drives leave, of that without them: below it is rounding, and there is
// none.
constexpr double k_driven = 1e-12;
// Velocity that counts as rest where drives alone decide it, of those it is a difference of: their
// rounding.
constexpr double k_rest = 1e-10;
constexpr double k_tolerances_at_rest = 10.0;
// Wrenches that stick together: proximal iterations, each within this of the problem, whose limit
// is of all solutions the least (weighted) where rows depend on each other.
constexpr double k_proximal = 1e-10;
constexpr int k_proximal_steps = 4;
// Velocity that is rest, of what the other elements give: their wrenches are known to k_settled, or
// this many times the last change. On the boundary without a velocity an element sticks: many ways
// to share a load lead there.
constexpr double k_rest_of_others = 1e-7, k_changes_at_rest = 10.0;
// Of what an element bears, by which its wrench is changed to see what that does to bounds; where that is too much,
// less by this factor, so many times.
constexpr double k_probe = 1e-2, k_shorter = 1e-2;
constexpr int k_probes = 6;
constexpr int k_sets_expected = 8; // of modes that a step tries: memory for them
constexpr double k_held = 1e-6;    // what is left of the free velocities, relatively, where holding is possible

} // namespace

// Stuck before this step at the same place: its anchor stays, and with it what an element has
// worked out there.
bool TimeStepping::has_held(const FrictionState& friction, int f) const {
  return start_.friction[f].phase == FrictionPhase::stick && start_.friction[f].foot == friction.foot;
}

// Elements that can bear anything, anchored where they are; their rows are forces here, not
// constraints.
void TimeStepping::collect_friction(Dynamics& dynamics, State& state) {
  parts_.clear();
  rows_ = 0;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    const FrictionElement& element = *system_.frictions[f].friction;
    FrictionState& friction = state.friction[f];
    if (friction.phase == FrictionPhase::apart || element.never_slips()) continue;
    FrictionState before = friction; // a joint that sticks cannot come apart: the phase counts
    before.phase = start_.friction[f].phase;
    if (element.watch_place(dynamics.evaluation(), before) < 0.0) element.change_place(dynamics.evaluation(), friction);
    if (friction.phase == FrictionPhase::apart) continue;
    const RowSpec* rows = element.rows(friction);
    for (int r = 0; r < element.dimension() && !has_held(friction, f); ++r)
      if (rows[r].memory >= 0) state.memory[rows[r].memory] = evaluate_row<false>(rows[r], dynamics.motion().data()).value;
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

// Gradient of a friction row in the clusters' coordinates.
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
  for (int c = 0; c < 3; ++c) row.g[0][c] += row.g[1][c]; // two bodies that move as one
  row.cluster[1] = -1;
}

// Responses to unit forces along the friction rows, with all that joints and drives answer.
void TimeStepping::respond(Dynamics& dynamics, double h) {
  const std::vector<double>& w = linearization_.inverse_mass();
  const auto n2 = static_cast<std::size_t>(2 * n_), rows = static_cast<std::size_t>(rows_);
  for (const FrictionPart& part : parts_) {
    const RowSpec* specs = system_.frictions[part.friction].friction->rows(dynamics.evaluation().friction[part.friction]);
    for (int i = 0; i < part.dimension; ++i) load_row(dynamics, specs[i], gradient_[part.first + i]);
  }
  matrix_.reserve(rows * rows); // of hold_together, which may be asked for the first time late
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
    stages_.respond(right_.data(), &response_[r * n2]);
  }
  for (std::size_t i = 0; i < rows; ++i)
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3 && gradient_[i].cluster[side] >= 0; ++c) {
        const std::size_t k = n_ + 3 * gradient_[i].cluster[side] + c;
        for (std::size_t j = 0; j < rows; ++j) compliance_[i * rows + j] += gradient_[i].g[side][c] * response_[j * n2 + k];
      }
  for (FrictionPart& part : parts_) find_driven(part, h);
}

// Directions along which joints and drives leave no mobility: no wrench changes the velocity there.
void TimeStepping::find_driven(FrictionPart& part, double h) {
  const std::vector<double>& w = linearization_.inverse_mass();
  Mat3 scaled = Mat3::Identity();
  Vec3 scale = Vec3::Ones(); // by the mobility without joints
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

// The rows' rates at the step's end as it is, on the constraints, less what the wrenches make of
// them.
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

// What an element of one dimension bears at the evaluation `e`.
double TimeStepping::bound_of(const Evaluation& e, const FrictionPart& part, bool is_kinetic) const {
  const FrictionElement& element = *system_.frictions[part.friction].friction;
  const FrictionState& friction = e.friction[part.friction];
  if (!element.is_loaded(e, friction)) return 0.0;
  const double a[9] = {}, b[3] = {-1.0}; // no wrench helps: it is the largest
  return element.solve_block(e, friction, a, b, is_kinetic).wrench[0];
}

// Bounds as functions of the wrenches, linear at those that are now. Normal forces end at zero, and with them what
// wrenches do to them: an element whose wrench has made its own vanish begins anew without one.
void TimeStepping::couple_bounds(Dynamics& dynamics, double t1, double tolerance) {
  const bool is_first = !is_coupled_;
  is_coupled_ = true;
  bool is_moved = false;
  for (const FrictionPart& part : parts_) {
    double& wrench = wrench_[part.first];
    if (part.dimension != 1 || wrench == 0.0) continue;
    if (!is_first && bound_of(dynamics.evaluation(), part, false) > 0.0) continue;
    wrench = 0.0; // repetition may have thrown it anywhere
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

// What a wrench of element `by` changes of all bounds: a difference, short enough that none ends at zero.
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

// One dimension, its bound linear in its own wrench w, B(w) = bound + slope w: sticks where |w| ≤ B holds it, else
// slides either way with w = ∓B(w) against the rate a w + b that it then has. Where more than one is possible (Painlevé's
// paradox) it sticks.
FrictionBlock TimeStepping::solve_coupled(const FrictionPart& part, double a, double b) const {
  const std::size_t row = part.first;
  const double* const by = &bound_by_[row * rows_];
  double bound = part.bound - by[row] * bound_at_[row], slope = by[row];
  for (int j = 0; j < rows_; ++j)
    if (j != part.first) bound += by[j] * (wrench_[j] - bound_at_[j]);
  if (part.is_kinetic) {
    bound *= part.kinetic_share;
    slope *= part.kinetic_share;
  }
  FrictionBlock block;
  const double held = a > 0.0 ? -b / a : 0.0;
  block.is_inside = a > 0.0 && std::abs(held) <= bound + slope * held;
  block.wrench[0] = held;
  if (block.is_inside) return block;
  double least = std::numeric_limits<double>::infinity();
  for (const double sign : {1.0, -1.0}) { // of the rate
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

// One element for the others' wrenches as they are.
FrictionBlock TimeStepping::solve_part(const Evaluation& e, const FrictionPart& part) const {
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
    if (std::abs(b[0]) <= part.noise) return {}; // what it takes is the drive's to say: none
    a[0] = 1e-30 * std::abs(b[0]);               // any wrench changes as good as nothing: it slides
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

// Sizes of wrenches that compare between forces and couples: the root of the energy that they give
// alone.
double TimeStepping::size_of(const FrictionPart& part, const double* wrench) const {
  double size = 0.0;
  for (int i = 0; i < part.dimension; ++i) {
    const std::size_t r = part.first + i;
    size = std::max(size, std::abs(wrench[r]) * std::sqrt(std::max(0.0, compliance_[r * rows_ + r])));
  }
  return size;
}

// The largest wrench, or what an element of one dimension bears, if that is more: a wheel that rolls on by itself takes a
// friction force of zero, and what rounding makes of that is no change.
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

// Of an element's wrench against that before (of its dimension), relative to its own size or a
// small share of the largest.
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

// Each element once; the largest change, and whose it is.
double TimeStepping::sweep(Dynamics& dynamics, int& worst) {
  const Evaluation& e = dynamics.evaluation();
  last_ = wrench_;
  double largest = 0.0, size = largest_size(e);
  for (FrictionPart& part : parts_) {
    FrictionBlock block;
    block.is_inside = false;
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

// The wrenches of all elements that stick at once, those that slip as they are: where the guess of
// who sticks is right, the next sweep changes nothing. Left as they are where no wrenches can hold
// all of them.
void TimeStepping::hold_together() {
  held_.clear();
  for (const FrictionPart& part : parts_)
    for (int i = 0; part.block.is_inside && !part.is_driven && i < part.dimension; ++i) held_.push_back(part.first + i);
  if (held_.empty() || !hold_rows()) return;
  for (std::size_t i = 0; i < held_.size(); ++i) wrench_[held_[i]] = together_[i];
}

// The wrenches together_ that bring the rows held_ to rest, the least where many do. False where none can.
bool TimeStepping::hold_rows() { return factor_held(k_proximal) && solve_held(k_proximal_steps) <= k_held; }

// L Lᵀ of the symmetric part of the compliance of the rows held_, its diagonal raised by the share `proximal`. False if it is not
// positive definite.
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

// The wrenches together_ by so many proximal iterations with the factors of factor_held(), all others as they are. Returns the share of the rows' velocity without them that is left.
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

// Do all elements bear the wrenches before the last sweep and `share` of what it changed?
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
    if (!element.solve_block(e, e.friction[part.friction], a, b, part.is_kinetic).is_inside) return false;
  }
  return true;
}

// Rows that are nearly dependent (two feet of a box that has turned a little) leave the problem as
// good as flat along what they take from each other, and sweeps creep along there: as far as the
// energy falls and all elements bear it at once.
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

// Elements on the boundary of what they bear whose velocity is that of the others' remaining
// changes.
void TimeStepping::stop_at_rest(double change) {
  const double share = std::max(k_rest_of_others, k_changes_at_rest * change);
  for (FrictionPart& part : parts_) {
    if (part.block.is_inside || part.is_driven) continue;
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
    part.block.is_inside = velocity <= share * others;
  }
}

// Block Gauss–Seidel: each element's wrench for the others' as they are, with static or kinetic coefficients as they are.
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
