#include "mbd/trust/frozen_growth.h"

#include "mbd/base/counter_random.h"
#include "mbd/base/decompositions.h"
#include "mbd/base/portable_math.h"
#include "mbd/dynamics/linearization.h"
#include "mbd/rest/free_vibration.h"
#include "mbd/rest/tangent.h"
#include "mbd/system/one_way_lock.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_rounded_terms = 64.0;
constexpr double k_part_of_motion = 1e-3;      // fraction of a direction of motion; a smaller component along Z is rounding
constexpr double k_skew = 1e-9;                // relative to A; a smaller asymmetry is rounding
constexpr double k_real = 1e-6;                // imaginary part over modulus of an eigenvalue; below this the growth counts as real
constexpr Eigen::Index k_most_companion = 120; // largest number of directions; the dense eigenvalue problem has twice the size
constexpr int k_bisections = 30;
// Rows whose independent part is below this fraction of their length are dependent, friction rows included (theory.md).
constexpr double k_rank = 1e-6;
// Cosine of 6°. A curved path deviates from the span of its recorded chords by less than that before a further chord is recorded.
constexpr double k_within = 0.995;
constexpr double k_even = 1e-3; // fraction of the speed; smaller changes of velocity count as even motion
constexpr double k_idle = 1e-9; // fraction of the largest force; a smaller reaction counts as none
// Displacement by which contacts in touch are found, as a fraction of a body's size: far above rounding of gaps given as zero, far below
// the compression by loads.
constexpr double k_trial = 1e-9; // fraction of a body's size
constexpr std::uint64_t k_trials = 2;

bool is_positive_definite(MatX p) {
  const Eigen::Index n = p.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(p(k, k) > 0.0)) return false;
    const VecX column = p.col(k).tail(n - k - 1);
    p.bottomRightCorner(n - k - 1, n - k - 1).noalias() -= column * (column.transpose() / p(k, k));
  }
  return true;
}

MatX symmetric_part(const MatX& a) { return 0.5 * (a + a.transpose()); }

// Returns P(σ) = σ² − σ B − A for σ = `rate`.
MatX at_rate(const MatX& a, const MatX& b, double rate) {
  MatX p = -a - rate * b;
  p.diagonal().array() += rate * rate;
  return p;
}

struct FastestGrowth {
  double rate = 0.0;
  VecX eta;
  double swing = 0.0;     // as in FrozenGrowth
  bool may_swing = false; // true: the general eigenvalue problem was solved, in which growth may oscillate
};

// Returns the largest σ for which P(σ) is singular, by bisection on positive definiteness. Preconditions: symmetric A, and σ > `least`.
FastestGrowth fastest_of_symmetric(const MatX& a, const MatX& b, double least) {
  double low = least, high = std::max(2.0 * least, std::sqrt(std::max(symmetric_eigen(a).values.maxCoeff(), 0.0)));
  for (int i = 0; i < k_bisections && high - low > 1e-6 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (is_positive_definite(at_rate(a, b, middle)) ? high : low) = middle;
  }
  return {high, symmetric_eigen(at_rate(a, b, high)).vectors.col(0), 0.0, false};
}

enum class Swings : unsigned char { count, do_not_count };

// Returns the eigenvalue of the first-order equations with the largest real part. Rigid motions without stiffness are separated first, with
// a tolerance for rounding: size_of returns |K| |x| for displacements x along `v.basis`. Without Swings::count oscillating growth is
// ignored.
FastestGrowth fastest_of_all(FreeVibration v, const std::function<MatX(const MatX&)>& size_of, Swings swings) {
  FastestGrowth found;
  if (v.a.cols() > k_most_companion) return found;
  v.separate_null_motions(size_of);
  std::vector<FreeMode> modes;
  try {
    modes = modes_of(v);
  } catch (const NumericalFailure&) {
    return found; // the eigenvalues do not converge: no growth is reported
  }
  for (const FreeMode& mode : modes) {
    const double rate = mode.eigenvalue.real();
    if (swings == Swings::do_not_count && std::abs(mode.eigenvalue.imag()) > k_real * rate) continue;
    if (rate <= found.rate) continue;
    // Choose the phase of the oscillation in which the displacement is largest: xᵀx real and positive.
    const std::complex<double> square = (mode.x.transpose() * mode.x)(0, 0);
    const double half = 0.5 * portable::atan2(square.imag(), square.real());
    const VecX eta = mode.x.real() * portable::cos(half) + mode.x.imag() * portable::sin(half);
    found = {rate, eta, std::abs(mode.eigenvalue.imag()) > k_real * rate ? portable::hypot(rate, mode.eigenvalue.imag()) : 0.0, false};
  }
  return found;
}

// Returns the fastest growth if it may exceed `least`, 1/s; otherwise an empty result.
FastestGrowth fastest_above(double least, const FreeVibration& v, const std::function<MatX(const MatX&)>& size_of, Swings swings) {
  const auto is_skewed = [](const MatX& m) { return (m - m.transpose()).cwiseAbs().sum() > k_skew * m.cwiseAbs().sum(); };
  const bool is_skew = is_skewed(v.a);
  const MatX a = symmetric_part(v.a), b = symmetric_part(v.b);
  // For symmetric A an oscillation of shape x grows at the rate xᵀBx/2.
  const bool may_swing = swings == Swings::count && (is_skew || is_skewed(v.b) || symmetric_eigen(b).values.maxCoeff() > 2.0 * least);
  if (!may_swing && is_positive_definite(at_rate(a, b, least))) return {};
  if (!may_swing && !is_skew) return fastest_of_symmetric(a, b, least);
  FastestGrowth fastest = fastest_of_all(v, size_of, swings);
  fastest.may_swing = may_swing;
  return fastest;
}

bool is_steady_motion(const System& system, const LegMotion& leg) {
  double speed = 0.0;
  for (const double v : leg.begin.v) speed = std::max(speed, std::abs(v));
  if (!(speed > 0.0)) return false;
  const auto is_even = [&](const State& state) {
    for (std::size_t i = 0; i < state.v.size(); ++i) {
      const double wanted = i % 3 < 2 ? leg.begin.v[i] : 0.0;
      if (!(std::abs(state.v[i] - wanted) <= k_even * speed)) return false;
    }
    return true;
  };
  return system.inner_count() == 0 && is_even(leg.begin) && !leg.states.empty() &&
         std::all_of(leg.states.begin(), leg.states.end(), is_even);
}

// Returns true for a row that resists in one direction only and may touch without force: a rope that is just taut, a freewheel without
// drag.
bool is_one_sided(const FrictionUnit& unit) {
  if (unit.rope) return true;
  const OneWayLock* const lock = one_way_lock(unit);
  return lock && lock->drag() == 0.0;
}

} // namespace

FrozenLeg::FrozenLeg(const System& system, const LegMotion& leg)
    : system_(system), leg_(leg), weights_(Eigen::Map<const VecX>(leg.moved.weights().data(), 3 * (system.body_count() - 1))),
      dynamics_(system), statics_(system), is_at_rest_(leg.moved.directions().empty() && system.inner_count() == 0),
      is_steady_(!is_at_rest_ && is_steady_motion(system, leg)) {
  find_variants();
}

// Linearises at `state`. The reactions are taken from the run's equations of motion, because statics does not contain inertial loads.
void FrozenLeg::linearise(const State& state, const Variant& variant) {
  if (linearised_ == &variant && state.t == at_run_.t && state.q == at_run_.q && state.v == at_run_.v) return;
  linearised_ = &variant;
  at_run_ = at_rest_ = state;
  dynamics_.clear_layouts();
  dynamics_.set_state(at_run_);
  y_.resize(static_cast<std::size_t>(system_.largest_dimension()));
  std::vector<double> dy(y_.size());
  dynamics_.pack(at_run_, y_.data());
  dynamics_.rates(at_run_.t, y_.data(), dy.data());
  const Snapshot now = dynamics_.snapshot(dy.data());
  for (Eigen::Index i = 0; i < variant.displacement.size(); ++i) at_rest_.q[static_cast<std::size_t>(i) + 3] += variant.displacement[i];
  statics_.evaluate(at_rest_);
  statics_.collect_rows(at_rest_);
  take_reactions(now);
  if (!variant.is_let_go) return;
  statics_.collect_rows(at_rest_, idle_one_sided_rows());
  take_reactions(now);
}

void FrozenLeg::take_reactions(const Snapshot& now) {
  lambda_.resize(static_cast<Eigen::Index>(statics_.rows().size()));
  for (std::size_t i = 0; i < statics_.rows().size(); ++i) {
    const StaticRow& row = statics_.rows()[i];
    lambda_[static_cast<Eigen::Index>(i)] = row.row >= 0 ? now.row_force[row.row] : now.friction_force[row.friction_row];
  }
}

// Returns flags, by slot of Snapshot::friction_force, of one-sided rows that carry no force; empty if there are none.
std::vector<char> FrozenLeg::idle_one_sided_rows() const {
  std::vector<char> idle;
  double size = 0.0;
  if (lambda_.size() > 0) size = lambda_.cwiseAbs().maxCoeff();
  if (statics_.force().size() > 0) size = std::max(size, statics_.force().cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < statics_.rows().size(); ++i) {
    const StaticRow& row = statics_.rows()[i];
    if (row.friction < 0 || !is_one_sided(system_.frictions[static_cast<std::size_t>(row.friction)])) continue;
    if (std::abs(lambda_[static_cast<Eigen::Index>(i)]) > k_idle * size) continue;
    const auto slot = static_cast<std::size_t>(row.friction_row);
    if (idle.size() <= slot) idle.resize(slot + 1, 0);
    idle[slot] = 1;
  }
  if (!idle.empty())
    for (const FrictionUnit& unit : system_.frictions)
      idle.resize(std::max(idle.size(), static_cast<std::size_t>(unit.row + unit.friction->dimension())), 0);
  return idle;
}

// Returns pseudo-random displacements along the free directions, each followed by its mirror image: a contact that touches without force
// opens under one of the two.
std::vector<VecX> FrozenLeg::trial_displacements() const {
  std::vector<VecX> trials;
  for (std::uint64_t trial = 0; trial < k_trials; ++trial) {
    VecX parts(first_.cols());
    for (Eigen::Index i = 0; i < parts.size(); ++i) parts[i] = 2.0 * counter_uniform(trial, 11, 0, static_cast<std::uint32_t>(i)) - 1.0;
    VecX displacement = weights_.cwiseInverse().cwiseProduct(first_ * parts);
    double largest = 0.0; // relative to a body's size
    for (Eigen::Index body = 0; 3 * body < displacement.size(); ++body) {
      const double radius = weights_[3 * body + 2] / weights_[3 * body];
      const double way = std::max(displacement.segment<2>(3 * body).norm(), radius * std::abs(displacement[3 * body + 2]));
      if (radius > 0.0) largest = std::max(largest, way / radius);
    }
    if (!(largest > 0.0)) continue;
    displacement *= k_trial / largest;
    trials.push_back(displacement);
    trials.push_back(-displacement);
  }
  return trials;
}

void FrozenLeg::find_variants() {
  const Rows rows = is_at_rest_ ? Rows::all : Rows::of_places;
  variants_.assign(1, {{}, false});
  linearise(leg_.begin, variants_.front());
  if (const std::vector<char> idle = idle_one_sided_rows(); !idle.empty()) {
    variants_.push_back({{}, true});
    linearise(leg_.begin, variants_.back());
  }
  first_ = unmoved_directions(rows);
  linearised_ = nullptr; // not valid any more: variants_ may be reallocated, and statics_ is evaluated at other poses
  if (first_.cols() == 0) return;
  std::vector<std::vector<UnitMode>> seen = {at_rest_.mode};
  for (const VecX& displacement : trial_displacements()) {
    State displaced = leg_.begin;
    for (Eigen::Index i = 0; i < displacement.size(); ++i) displaced.q[static_cast<std::size_t>(i) + 3] += displacement[i];
    statics_.evaluate(displaced);
    if (std::find(seen.begin(), seen.end(), displaced.mode) != seen.end()) continue;
    seen.push_back(displaced.mode);
    variants_.push_back({displacement, true});
  }
}

// Returns Z: an orthonormal basis of the directions that the rows leave free.
MatX FrozenLeg::free_directions(Rows rows) const {
  const auto is_of_rates = [](const StaticRow& row) { return row.spec->kind == MeasureKind::skate; };
  if (rows == Rows::all || std::none_of(statics_.rows().begin(), statics_.rows().end(), is_of_rates)) {
    const VecX scale = scale_of(system_, at_rest_).scale;
    const MatX along = weights_.asDiagonal() * (scale.asDiagonal() * tangent_of(statics_, scale).free);
    if (along.cols() == 0) return along;
    return solve_lower(along.transpose() * along, along.transpose()).transpose();
  }
  const MatX gradient = statics_.gradient() * weights_.cwiseInverse().asDiagonal();
  std::vector<VecX> held;
  for (std::size_t i = 0; i < statics_.rows().size(); ++i)
    if (!is_of_rates(statics_.rows()[i])) held.emplace_back(gradient.row(static_cast<Eigen::Index>(i)).normalized());
  if (held.empty()) return MatX::Identity(weights_.size(), weights_.size());
  MatX columns(weights_.size(), static_cast<Eigen::Index>(held.size()));
  for (std::size_t i = 0; i < held.size(); ++i) columns.col(static_cast<Eigen::Index>(i)) = held[i];
  return PivotedQr(columns, k_rank).complement();
}

// Returns orthonormal directions in which the leg moves, in coordinates along Z; may be empty. Without drives they are the projections of
// the motion on Z. A drive also moves all bodies that the driven one carries, and these projections would mislead: a rod that rides upright
// on a car does not tilt. With drives, only those combinations of motions count that keep all driven coordinates constant and lie within Z.
MatX FrozenLeg::moved_directions(const MatX& free) const {
  const auto count = static_cast<Eigen::Index>(leg_.moved.directions().size());
  if (count == 0) return MatX(free.cols(), 0);
  MatX directions(free.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i)
    directions.col(i) = Eigen::Map<const VecX>(leg_.moved.directions()[static_cast<std::size_t>(i)].data(), free.rows());
  std::vector<VecX> driven;
  const auto is_driven = [](const StaticRow& row) { return row.spec->drive != nullptr; };
  if (std::any_of(statics_.rows().begin(), statics_.rows().end(), is_driven)) {
    const MatX gradient = statics_.gradient() * weights_.cwiseInverse().asDiagonal();
    for (std::size_t i = 0; i < statics_.rows().size(); ++i)
      if (is_driven(statics_.rows()[i]))
        driven.emplace_back(directions.transpose() * gradient.row(static_cast<Eigen::Index>(i)).transpose().normalized());
  }
  std::erase_if(driven, [](const VecX& part) { return !(part.norm() > k_part_of_motion); });
  if (driven.empty()) {
    MatX moved = free.transpose() * directions;
    if (!(moved.colwise().norm().maxCoeff() > k_part_of_motion)) return MatX(free.cols(), 0);
    return moved;
  }
  MatX by_drives(count, static_cast<Eigen::Index>(driven.size()));
  for (std::size_t i = 0; i < driven.size(); ++i) by_drives.col(static_cast<Eigen::Index>(i)) = driven[i];
  const MatX others = PivotedQr(by_drives, k_part_of_motion).complement();
  if (others.cols() == 0) return MatX(free.cols(), 0);
  const MatX along = free.transpose() * (directions * others);
  const RightSingular angles = right_singular(along); // cosines of the angles between the two subspaces
  Eigen::Index within = 0;
  while (within < angles.values.size() && angles.values[within] > k_within) ++within;
  return along * angles.v.leftCols(within);
}

MatX FrozenLeg::unmoved_directions(Rows rows) const {
  const MatX free = free_directions(rows);
  if (free.cols() == 0) return free;
  const MatX moved = moved_directions(free);
  return moved.cols() == 0 ? free : MatX(free * PivotedQr(moved, k_part_of_motion).complement());
}

FrozenGrowth FrozenLeg::growth_at(const State& state, double least, std::size_t variant) {
  const OneThread alone;
  linearise(state, variants_[variant]);
  const MatX z = unmoved_directions(Rows::all);
  if (z.cols() == 0) return {};
  const MatX unweighted = weights_.cwiseInverse().asDiagonal() * z;
  const MatX stiffness = statics_.stiffness(lambda_);
  const MatX a = unweighted.transpose() * stiffness * unweighted, b = unweighted.transpose() * statics_.damping() * unweighted;
  const MatX size = stiffness.cwiseAbs();
  const auto size_of = [&size](const MatX& shapes) { return MatX(size * shapes.cwiseAbs()); };
  const FastestGrowth fastest =
      fastest_above(least, {a, b, unweighted, {}, {}}, size_of, is_at_rest_ ? Swings::count : Swings::do_not_count);
  if (!(fastest.rate > least)) return {};
  const VecX shape = (z * fastest.eta).normalized();
  if (fastest.may_swing) return {fastest.rate, shape, fastest.swing};
  // The growth must come from a negative stiffness that is larger than the rounding of its terms.
  const VecX place = weights_.cwiseInverse().cwiseProduct(shape);
  const double rounding = k_epsilon * (k_rounded_terms * place.cwiseAbs().dot(size * place.cwiseAbs()) + 4.0 * a.cwiseAbs().maxCoeff());
  if (!(place.dot(stiffness * place) > rounding)) return {};
  return {fastest.rate, shape, 0.0};
}

// The linearised equations have other coordinates than Z: displacements of bodies are T times those of their clusters, and displacements of
// clusters are S times those of their root bodies.
FrozenGrowth FrozenLeg::steady_growth_at(const State& state, double least) {
  const OneThread alone;
  linearise(state, variants_.front());
  const Layout& layout = dynamics_.layout();
  if (layout.has_mechanisms()) return {};
  const MatX z = unmoved_directions(Rows::of_places);
  if (z.cols() == 0) return {};
  Linearization whole;
  whole.evaluate(dynamics_, at_run_.t, y_.data());
  MatX by_pose, by_velocity;
  whole.acceleration_by_state(by_pose, by_velocity);
  const Eigen::Index n = weights_.size(), m = by_pose.rows();
  MatX t = MatX::Zero(n, m), s = MatX::Zero(m, n);
  for (int body = 1; body < system_.body_count(); ++body) {
    const int cluster = layout.placements[static_cast<std::size_t>(body)].cluster;
    if (cluster < 0) continue;
    const Eigen::Index row = 3 * body - 3, column = 3 * cluster;
    const double x = at_run_.q[static_cast<std::size_t>(3 * body)] - y_[static_cast<std::size_t>(column)];
    const double y = at_run_.q[static_cast<std::size_t>(3 * body) + 1] - y_[static_cast<std::size_t>(column) + 1];
    t.block<3, 3>(row, column) << 1.0, 0.0, -y, 0.0, 1.0, x, 0.0, 0.0, 1.0;
    if (layout.clusters[static_cast<std::size_t>(cluster)].root == body)
      s.block<3, 3>(column, row) << 1.0, 0.0, y, 0.0, 1.0, -x, 0.0, 0.0, 1.0;
  }
  const MatX out = z.transpose() * weights_.asDiagonal() * t, in = s * weights_.cwiseInverse().asDiagonal() * z;
  const MatX a = out * by_pose * in, b = out * by_velocity * in;
  const MatX size = out.cwiseAbs() * by_pose.cwiseAbs() * in.cwiseAbs();
  const auto size_of = [&size](const MatX& shapes) { return MatX(size * shapes.cwiseAbs()); };
  const FastestGrowth fastest = fastest_above(least, {a, b, MatX::Identity(z.cols(), z.cols()), {}, {}}, size_of, Swings::count);
  if (!(fastest.rate > least)) return {};
  return {fastest.rate, (z * fastest.eta).normalized(), fastest.swing};
}

} // namespace steplap
