#include "mbd/analysis/descent.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_first_radius = 0.1, k_first_turn = 0.3; // of the trust region: of the scene's length; rad
// rad: poses half a turn apart are not to be taken for each other
constexpr double k_small_turn = 0.4, k_largest_turn = 1.5;
constexpr double k_balanced = 1e-11;  // Newton steps below this share of the length are the pose's rounding
constexpr double k_nearly_balanced = 1e-8;
constexpr double k_nudge = 1e-3;      // of the length, rad
constexpr double k_turned_against = 0.5; // of the work along the tangent
constexpr double k_far = 1e4;         // lengths of the scene
constexpr double k_many_turns = 40.0 * std::numbers::pi;
constexpr double k_most_looks = 1000.0; // along a step
constexpr int k_most_trials = 44, k_most_corrections = 4, k_most_projections = 25, k_most_polishing = 4;
constexpr double k_rounded_terms = 32.0;

int most_iterations(int n) { return n <= 90 ? 3000 : n <= 300 ? 600 : 150; }

} // namespace

Descent::Descent(const System& system, State& state)
    : system_(system), state_(state), statics_(system), n_(statics_.coordinates()), start_(state.q),
      hold_(system.frictions.size(), Hold::none) {
  std::fill(state_.v.begin(), state_.v.end(), 0.0);
  for (std::size_t f = 0; f < hold_.size(); ++f) {
    const FrictionPhase phase = state.friction[f].phase;
    hold_[f] = phase == FrictionPhase::stick ? Hold::sticks : phase == FrictionPhase::slip ? Hold::slides : Hold::none;
  }
  measure_scene();
  radius_ = k_first_radius * length_;
  turn_ = k_first_turn;
}

void Descent::measure_scene() {
  const SceneScale scene = scale_of(system_, state_);
  length_ = scene.length;
  reach_ = scene.reach;
  scale_ = scene.scale;
  mass_ = VecX(n_);
  for (int k = 0; k < n_; ++k) {
    const BodyData& body = system_.bodies[k / 3 + 1];
    mass_[k] = k % 3 < 2 ? body.mass : body.inertia * scale_[k] * scale_[k];
  }
}

void Descent::linearise() {
  statics_.evaluate(state_);
  statics_.collect_rows(state_);
  const Tangent t = tangent_of(statics_, scale_);
  kept_ = t.kept;
  gradient_ = scale_.cwiseProduct(statics_.force());
  lambda_ = multipliers_of(statics_, scale_, t);
  stiffness_ = scale_.asDiagonal() * statics_.stiffness(lambda_) * scale_.asDiagonal();
  VecX reactions = VecX::Zero(n_);
  if (!t.kept.empty()) reactions = t.held.cwiseAbs() * (t.held.transpose() * gradient_).cwiseAbs();
  VecX place(n_);
  for (int i = 0; i < n_; ++i) place[i] = std::max(length_, std::abs(state_.q[i + 3]) / scale_[i]);
  const VecX rounding =
      k_rounded_terms * k_epsilon * (gradient_.cwiseAbs() + reactions + stiffness_.cwiseAbs() * place);
  gradient_ -= t.held * (t.held.transpose() * gradient_);
  shape_ = t.free;
  find_modes();
  share_rounding_ = shape_.cwiseAbs().transpose() * rounding;
}

// Mass-orthonormal shapes that the stiffness leaves apart.
void Descent::find_modes() {
  const Eigen::Index r = shape_.cols();
  value_ = share_ = value_rounding_ = VecX::Zero(r);
  if (r == 0) return;
  const Eigen::LLT<MatX> mass(shape_.transpose() * mass_.asDiagonal() * shape_);
  shape_ = mass.matrixL().solve(shape_.transpose()).transpose();
  const MatX turned = -(shape_.transpose() * stiffness_ * shape_);
  const Eigen::SelfAdjointEigenSolver<MatX> solver(0.5 * (turned + turned.transpose()));
  shape_ = shape_ * solver.eigenvectors();
  value_ = solver.eigenvalues();
  reduced_ = solver.eigenvectors().transpose() * turned * solver.eigenvectors();
  share_ = shape_.transpose() * gradient_;
  const MatX size = stiffness_.cwiseAbs() * shape_.cwiseAbs();
  const double largest = value_.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < r; ++i)
    value_rounding_[i] = k_epsilon * (k_rounded_terms * shape_.col(i).cwiseAbs().dot(size.col(i)) + 4.0 * largest);
}

double Descent::step_size(const VecX& step) const {
  double size = 0.0;
  for (int i = 0; i < n_; ++i)
    size = std::max(size, i % 3 < 2 ? std::abs(step[i]) / radius_ : std::abs(step[i]) * scale_[i] / turn_);
  return size;
}

bool Descent::is_loose(Eigen::Index i) const {
  return std::abs(value_[i]) <= value_rounding_[i] && std::abs(share_[i]) <= share_rounding_[i];
}

VecX Descent::regularised(double sigma) const {
  VecX share = share_;
  for (Eigen::Index i = 0; i < share.size(); ++i) share[i] = is_loose(i) ? 0.0 : share_[i] / (value_[i] + sigma);
  return shape_ * share;
}

// The σ at which the step ends at the border of the trust region; none where Newton's own step is inside.
VecX Descent::trust_step() const {
  double least = std::numeric_limits<double>::infinity(), largest = 0.0;
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    largest = std::max(largest, std::abs(value_[i]));
    if (!is_loose(i)) least = std::min(least, value_[i] - value_rounding_[i]);
  }
  used_sigma_ = 0.0;
  if (least > 0.0) {
    const VecX newton = regularised(0.0);
    if (step_size(newton) <= 1.0) return newton;
  }
  const double base = std::max(0.0, -least);
  double low = 0.0, high = std::max({1e-12 * largest, 1e-6 * base, 1e-30});
  for (int i = 0; i < 400 && step_size(regularised(base + high)) > 1.0; ++i) {
    low = high;
    high *= 4.0;
  }
  for (int i = 0; i < 12 && low > 0.0; ++i) {
    const double middle = std::sqrt(low * high);
    (step_size(regularised(base + middle)) > 1.0 ? low : high) = middle;
  }
  used_sigma_ = base + high;
  return regularised(used_sigma_);
}

// Newton's step with the whole stiffness, which is not symmetric under loads that turn with a body and under friction
// that slides; along what nothing holds there is none.
VecX Descent::newton_step() const {
  std::vector<Eigen::Index> firm;
  for (Eigen::Index i = 0; i < value_.size(); ++i)
    if (std::abs(value_[i]) > value_rounding_[i]) firm.push_back(i);
  const auto count = static_cast<Eigen::Index>(firm.size());
  if (count == 0) return VecX::Zero(n_);
  MatX a(count, count), w(n_, count);
  VecX g(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    g[i] = share_[firm[i]];
    w.col(i) = shape_.col(firm[i]);
    for (Eigen::Index j = 0; j < count; ++j) a(i, j) = reduced_(firm[i], firm[j]);
  }
  return w * a.partialPivLu().solve(g);
}

// Onto the rows, the nearest way; `end`: the tangent there.
bool Descent::project(Tangent& end) {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0;; ++i) {
    statics_.evaluate(state_);
    end = tangent_of(statics_, scale_, &kept_);
    if (statics_.rows().empty()) return true;
    const VecX off = statics_.off();
    const auto count = static_cast<Eigen::Index>(end.kept.size());
    VecX left(count);
    for (Eigen::Index k = 0; k < count; ++k) left[k] = off[end.kept[k]] / end.row_size[end.kept[k]];
    const double size = count == 0 ? 0.0 : left.cwiseAbs().maxCoeff();
    const double close = 8.0 * k_epsilon * reach_;
    if (!std::isfinite(size) || size > length_) return false;
    // Rows that depend on others are met with them, or not at all.
    if (size <= close || (size >= 0.5 * before && size <= 64.0 * close)) {
      for (int r = 0; r < statics_.bilateral_count(); ++r)
        if (!(std::abs(off[r]) <= 1e-7 * length_ * std::max(1.0, end.row_size[r]))) return false;
      return true;
    }
    if (i == k_most_projections || (i > 4 && size > 0.9 * before)) return false;
    before = size;
    const VecX move = end.held * end.triangle.transpose().triangularView<Eigen::Lower>().solve(left);
    for (int k = 0; k < n_; ++k) state_.q[k + 3] -= scale_[k] * move[k];
  }
}

bool Descent::move_to(const std::vector<double>& from, const VecX& step, Tangent& end) {
  for (int k = 0; k < n_; ++k) state_.q[k + 3] = from[k + 3] + scale_[k] * step[k];
  return project(end);
}

// Work against the step's tangent at its end.
static double slope_along(const VecX& step, const VecX& gradient, const MatX& held) {
  return -(step - held * (held.transpose() * step)).dot(gradient);
}

// Displacements that would restore the balance in the stiff directions, with the stiffness of the step's start; their
// largest in `size`.
VecX Descent::stiff_imbalance(const Tangent& end, double& size) const {
  VecX gradient = scale_.cwiseProduct(statics_.force());
  gradient -= end.held * (end.held.transpose() * gradient);
  VecX share = shape_.transpose() * gradient;
  for (Eigen::Index i = 0; i < share.size(); ++i) {
    const bool counts = value_[i] > 10.0 * used_sigma_ && value_[i] > value_rounding_[i];
    share[i] = counts ? share[i] / (value_[i] + used_sigma_) : 0.0;
  }
  const VecX move = shape_ * share;
  size = move.size() > 0 ? move.cwiseAbs().maxCoeff() : 0.0;
  return move;
}

// A step that bends away from a stiff contact's or spring's way is brought back to it; the slope there.
double Descent::correct(const VecX& step, const std::vector<double>& from, double slope, Tangent& end) {
  const std::vector<double> first = state_.q;
  const Tangent first_end = end;
  VecX moved = step;
  double before = 0.0, after = 0.0;
  VecX back = stiff_imbalance(end, before);
  if (before == 0.0) return slope;
  double now = slope;
  bool is_better = false;
  for (int round = 0; round < k_most_corrections; ++round) {
    moved += back;
    if (!(step_size(moved) < 2.0) || !move_to(from, moved, end)) {
      is_better = false;
      break;
    }
    back = stiff_imbalance(end, after);
    now = slope_along(step, scale_.cwiseProduct(statics_.force()), end.held);
    if (!(after < 0.5 * before)) break;
    is_better = true;
    before = after;
  }
  if (is_better && (now < slope || now < 0.0)) return now;
  state_.q = first;
  end = first_end;
  statics_.evaluate(state_);
  return slope;
}

// The share of a long step at which a contact first closes that its end may have passed through.
double Descent::first_contact(const std::vector<double>& from, const VecX& step) {
  double parts = 0.0; // in quarters of a body's size, and tenths of a radian
  for (int k = 0; k < n_; ++k) {
    const double inverse_size = scale_[k - k % 3 + 2];
    parts = std::max(parts, (k % 3 < 2 ? 4.0 : 10.0) * std::abs(step[k]) * inverse_size);
  }
  if (system_.contact_count == 0 || parts <= 1.0) return 1.0;
  const int count = static_cast<int>(std::min(std::ceil(parts), k_most_looks));
  const double* const force = statics_.evaluation().contact_force;
  const std::vector<double> open(force, force + system_.contact_count);
  double first = 1.0;
  for (int j = 1; j < count && first == 1.0; ++j) {
    for (int k = 0; k < n_; ++k) state_.q[k + 3] = from[k + 3] + scale_[k] * step[k] * j / count;
    statics_.evaluate(state_);
    for (int c = 0; c < system_.contact_count; ++c)
      if (open[c] <= 0.0 && force[c] > 0.0) first = static_cast<double>(j) / count;
  }
  state_.q = from;
  return first;
}

bool Descent::loads_friction() const {
  for (std::size_t f = 0; f < hold_.size(); ++f)
    if (hold_[f] == Hold::none && state_.friction[f].phase != FrictionPhase::apart &&
        system_.frictions[f].friction->is_loaded(statics_.evaluation(), state_.friction[f]))
      return true;
  return false;
}

// Friction holds a contact where it touched, not as deep as the step went: the share of the step at which the first one
// gets its load.
double Descent::first_load(const std::vector<double>& from, const VecX& step, double low, double high, Tangent& end) {
  if (!loads_friction()) return high;
  const std::vector<double> reached = state_.q;
  double taken = high;
  std::vector<double> place = reached;
  for (int i = 0; i < k_most_trials && taken - low > 1e-12 * taken; ++i) {
    const double middle = 0.5 * (low + taken);
    if (move_to(from, middle * step, end) && loads_friction()) {
      taken = middle;
      place = state_.q;
    } else {
      low = middle;
    }
  }
  state_.q = place;
  statics_.evaluate(state_);
  return taken;
}

// After a step that was taken at `factor` of what was planned.
void Descent::adapt_region(double factor, const VecX& step, bool is_straight) {
  double moved = 0.0, turned = 0.0;
  for (int k = 0; k < n_; ++k) {
    double& most = k % 3 < 2 ? moved : turned;
    most = std::max(most, std::abs(step[k]) * scale_[k]); // the scale of a displacement is 1
  }
  if (factor < 1.0) {
    radius_ = std::clamp(4.0 * moved, 0.25 * radius_, radius_);
    turn_ = std::min(k_small_turn, std::clamp(4.0 * turned, 0.25 * turn_, turn_));
    return;
  }
  if (moved > 0.5 * radius_) radius_ *= 2.0;
  if (turned > 0.5 * turn_) turn_ = is_straight ? std::min(k_largest_turn, 1.5 * turn_) : std::min(k_small_turn, 2.0 * turn_);
  else if (!is_straight) turn_ = std::min(turn_, k_small_turn);
}

bool Descent::advance(const VecX& step) {
  const std::vector<double> from = state_.q;
  const double start = -step.dot(gradient_);
  if (!(start < 0.0)) return false;
  Tangent end;
  const std::vector<UnitMode> modes = state_.mode;
  const double whole = first_contact(from, step);
  double low = 0.0, high = whole, slope = 0.0, factor = whole;
  bool is_taken = false;
  for (int trial = 0; trial < k_most_trials; ++trial) {
    bool is_too_far = !move_to(from, factor * step, end);
    if (!is_too_far) {
      slope = slope_along(step, scale_.cwiseProduct(statics_.force()), end.held);
      if (slope > -k_turned_against * start || state_.mode != modes) slope = correct(factor * step, from, slope, end);
      is_too_far = !(slope <= -k_turned_against * start);
      is_taken = !is_too_far && (factor == whole || slope >= k_turned_against * start);
    }
    if (is_taken) break;
    (is_too_far ? high : low) = factor;
    if (trial > 12 && low > 0.0 && high - low < 1e-3 * high) break;
    factor = 0.5 * (low + high);
  }
  if (!is_taken && low > 0.0) {
    factor = low;
    is_taken = move_to(from, factor * step, end);
  }
  if (!is_taken) {
    state_.q = from;
    return false;
  }
  factor = first_load(from, step, low < factor ? low : 0.0, factor, end);
  const bool is_straight = std::abs(slope - start) < 0.3 * std::abs(start);
  adapt_region(factor, factor * step, is_straight);
  follow_friction(from);
  return true;
}

// Friction that gets its load holds where it is, friction that is turned back, too; without load there is none.
void Descent::follow_friction(const std::vector<double>& from) {
  statics_.evaluate(state_);
  bool is_changed = false;
  for (int f = 0; f < static_cast<int>(system_.frictions.size()); ++f) {
    FrictionState& friction = state_.friction[f];
    if (friction.phase == FrictionPhase::apart) continue;
    const FrictionElement& element = *system_.frictions[f].friction;
    const FrictionPhase before = friction.phase;
    if (!element.is_loaded(statics_.evaluation(), friction)) {
      friction.phase = FrictionPhase::free;
      hold_[f] = Hold::none;
    } else if (before == FrictionPhase::slip && hold_[f] == Hold::slides) {
      const RowSpec& row = *element.rows(friction);
      std::vector<Motion<double>> motion;
      place_bodies(from, state_.v, motion);
      const double was = evaluate_row<false>(row, motion.data()).value;
      const double slid = evaluate_row<false>(row, statics_.motion().data()).value - was;
      if (slid * friction.sign >= -1e-9 * length_) continue;
      friction.phase = FrictionPhase::stick;
      anchor_friction(system_, state_, f);
      hold_[f] = Hold::sticks;
    } else {
      const bool is_displaced = element.watch_place(statics_.evaluation(), friction) < 0.0;
      if (is_displaced) element.change_place(statics_.evaluation(), friction);
      if (friction.phase == FrictionPhase::apart) continue;
      friction.phase = FrictionPhase::stick;
      if (is_displaced || hold_[f] != Hold::sticks) anchor_friction(system_, state_, f);
      hold_[f] = Hold::sticks;
    }
    is_changed = is_changed || friction.phase != before;
  }
  if (is_changed) statics_.evaluate(state_);
  statics_.collect_rows(state_);
}

MotionPart Descent::largest_part(const VecX& scaled) const {
  Eigen::Index at = 0;
  scaled.cwiseAbs().maxCoeff(&at);
  return {static_cast<int>(at) / 3 + 1, static_cast<int>(at) % 3, scaled[at] < 0.0 ? -1.0 : 1.0};
}

bool Descent::has_run_away() {
  VecX moved(n_);
  bool is_far = false;
  for (int k = 0; k < n_; ++k) {
    const double way = state_.q[k + 3] - start_[k + 3];
    is_far = is_far || !(std::abs(way) < (k % 3 < 2 ? k_far * length_ : k_many_turns));
    moved[k] = k % 3 < 2 ? way / (k_far * length_) : way / k_many_turns;
  }
  if (!is_far) return false;
  runaway_ = largest_part(moved);
  driving_force_ = std::abs(statics_.force()[3 * runaway_.body - 3 + runaway_.coordinate]);
  return true;
}

// Newton's steps to where rounding ends them.
bool Descent::polish() {
  bool is_better = false;
  for (int i = 0; i < k_most_polishing; ++i) {
    const State before = state_;
    const double size = share_.size() > 0 ? share_.cwiseAbs().maxCoeff() : 0.0;
    const VecX step = newton_step();
    Tangent end;
    if (!(step_size(step) <= 1.0) || !move_to(before.q, step, end)) {
      state_ = before;
      linearise();
      break;
    }
    linearise();
    if (share_.size() > 0 && !(share_.cwiseAbs().maxCoeff() < 0.5 * size)) {
      state_ = before;
      linearise();
      break;
    }
    is_better = true;
  }
  return is_better;
}

bool Descent::leave_saddle() {
  Eigen::Index worst = 0;
  if (value_.size() == 0 || !(value_.minCoeff(&worst) < -value_rounding_[worst])) return false;
  VecX direction = shape_.col(worst);
  const MotionPart part = largest_part(direction);
  const bool is_pushed = std::abs(share_[worst]) > 8.0 * share_rounding_[worst];
  if (is_pushed ? share_[worst] < 0.0 : part.sign < 0.0) direction = -direction;
  left_.push_back(largest_part(direction));
  radius_ = std::max(radius_, k_first_radius * length_);
  turn_ = k_first_turn;
  double largest = 0.0;
  for (int i = 0; i < n_; ++i)
    largest = std::max(largest, i % 3 < 2 ? std::abs(direction[i]) / length_ : std::abs(direction[i]) * scale_[i]);
  const std::vector<double> from = state_.q;
  Tangent end;
  for (double nudge = k_nudge; nudge > 1e-9; nudge *= 0.25)
    if (move_to(from, (nudge / largest) * direction, end)) {
      follow_friction(from);
      return true;
    }
  state_.q = from;
  return false;
}

// Directions in which the forces do not hold it back, with what friction that slides takes part in that.
int Descent::count_yielding() const {
  if (value_.size() == 0) return 0;
  const Eigen::EigenSolver<MatX> solver(reduced_, false);
  const double rounding = value_rounding_.maxCoeff();
  return static_cast<int>((solver.eigenvalues().real().array() <= rounding).count());
}

void Descent::finish() {
  yielding_ = count_yielding();
  VecX acceleration = share_.size() > 0 ? VecX(shape_ * share_) : VecX(VecX::Zero(n_));
  residual_ = acceleration.cwiseProduct(scale_).cwiseAbs().maxCoeff();
  indifferent_.clear();
  for (Eigen::Index i = 0; i < value_.size(); ++i)
    if (std::abs(value_[i]) <= value_rounding_[i]) indifferent_.push_back(largest_part(shape_.col(i)));
}

DescentEnd Descent::run() {
  const OneThread alone;
  statics_.evaluate(state_);
  follow_friction(state_.q);
  const std::vector<double> given = state_.q;
  linearise();
  Tangent first;
  if (!project(first)) state_.q = given;
  int failures = 0;
  for (iterations_ = 0; iterations_ < most_iterations(n_); ++iterations_) {
    linearise();
    if (iterations_ == 0) yielding_at_start_ = count_yielding();
    const VecX newton = newton_step();
    bool is_pushed = false; // along what nothing holds
    for (Eigen::Index i = 0; i < value_.size(); ++i)
      is_pushed = is_pushed || (std::abs(value_[i]) <= value_rounding_[i] && std::abs(share_[i]) > share_rounding_[i]);
    const double left = newton.size() > 0 ? newton.cwiseAbs().maxCoeff() : 0.0;
    if (!is_pushed && left <= (failures > 0 ? k_nearly_balanced : k_balanced) * length_) {
      polish();
      if (leave_saddle()) continue;
      finish();
      return DescentEnd::rest;
    }
    const bool is_skew = (reduced_ - reduced_.transpose()).cwiseAbs().sum() > 1e-9 * reduced_.cwiseAbs().sum();
    if (is_skew && !is_pushed && step_size(newton) <= 0.5 && polish()) {
      follow_friction(state_.q);
      continue;
    }
    if (advance(trust_step())) {
      failures = 0;
      if (has_run_away()) return DescentEnd::runs_away;
      continue;
    }
    if (++failures > 20) break;
    radius_ *= 0.1;
    turn_ *= 0.1;
  }
  finish();
  runaway_ = largest_part(share_.size() > 0 ? VecX(shape_ * share_) : VecX(VecX::Ones(n_)));
  driving_force_ = std::abs(statics_.force()[3 * runaway_.body - 3 + runaway_.coordinate]);
  return DescentEnd::no_way;
}

} // namespace steplap
