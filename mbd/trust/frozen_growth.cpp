#include "mbd/trust/frozen_growth.h"

#include "mbd/base/decompositions.h"
#include "mbd/rest/tangent.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_epsilon = std::numeric_limits<double>::epsilon();
constexpr double k_rounded_terms = 64.0;
constexpr double k_part_of_motion = 1e-3;      // of a direction of motion: less than that along the rows' free directions is none of them
constexpr double k_skew = 1e-9;                // of A: below that it is symmetric
constexpr double k_real = 1e-6;                // imaginary part of an eigenvalue, as a share of it: it grows without swinging
constexpr Eigen::Index k_most_companion = 120; // directions: eigenvalues of twice their number are found by dense algebra
constexpr int k_bisections = 30;

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

// P(σ)
MatX at_rate(const MatX& a, const MatX& b, double rate) {
  MatX p = -a - rate * b;
  p.diagonal().array() += rate * rate;
  return p;
}

struct Fastest {
  double rate = 0.0;
  VecX eta;
};

// `least` is exceeded.
Fastest fastest_of_symmetric(const MatX& a, const MatX& b, double least) {
  double low = least, high = std::max(2.0 * least, std::sqrt(std::max(symmetric_eigen(a).values.maxCoeff(), 0.0)));
  for (int i = 0; i < k_bisections && high - low > 1e-6 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (is_positive_definite(at_rate(a, b, middle)) ? high : low) = middle;
  }
  return {high, symmetric_eigen(at_rate(a, b, high)).vectors.col(0)};
}

// The largest real eigenvalue of the first-order equations.
Fastest fastest_of_skew(const MatX& a, const MatX& b, double rounding) {
  const Eigen::Index n = a.rows();
  if (n > k_most_companion) return {};
  const auto is_growing = [](const std::complex<double>& value) {
    return value.real() > 0.0 && std::abs(value.imag()) <= k_real * value.real();
  };
  const Eigen::VectorXcd squares = eigenvalues(a); // rounding parts a double zero of the first-order equations by its root
  if (std::none_of(squares.begin(), squares.end(), [&](const auto& value) { return is_growing(value) && value.real() > rounding; }))
    return {};
  MatX whole = MatX::Zero(2 * n, 2 * n);
  whole.topRightCorner(n, n).setIdentity();
  whole.bottomLeftCorner(n, n) = a;
  whole.bottomRightCorner(n, n) = b;
  const Eigenpairs pairs = eigenpairs(whole);
  Fastest found;
  if (!pairs.is_converged) return found;
  for (Eigen::Index i = 0; i < 2 * n; ++i) {
    if (!is_growing(pairs.values[i]) || pairs.values[i].real() <= found.rate) continue;
    found = {pairs.values[i].real(), pairs.vectors.col(i).head(n).real()};
  }
  return found;
}

} // namespace

FrozenLeg::FrozenLeg(const System& system, const LegMotion& leg)
    : system_(system), leg_(leg), weights_(Eigen::Map<const VecX>(leg.moved.weights().data(), 3 * (system.body_count() - 1))),
      dynamics_(system), statics_(system) {
  linearise(leg.begin);
  first_ = unmoved_directions();
}

// Reactions are those of the run's own equations at that instant; statics alone knows none of inertial loads.
void FrozenLeg::linearise(const State& state) {
  at_run_ = at_rest_ = state;
  dynamics_.forget_layouts();
  dynamics_.set_state(at_run_);
  std::vector<double> y(static_cast<std::size_t>(system_.largest_dimension())), dy(y.size());
  dynamics_.pack(at_run_, y.data());
  dynamics_.rates(at_run_.t, y.data(), dy.data());
  const Snapshot now = dynamics_.snapshot(dy.data());
  statics_.evaluate(at_rest_);
  statics_.collect_rows(at_rest_);
  lambda_.resize(static_cast<Eigen::Index>(statics_.rows().size()));
  for (std::size_t i = 0; i < statics_.rows().size(); ++i) {
    const StaticRow& row = statics_.rows()[i];
    lambda_[static_cast<Eigen::Index>(i)] = row.row >= 0 ? now.row_force[row.row] : now.friction_force[row.friction_row];
  }
}

MatX FrozenLeg::unmoved_directions() const {
  const VecX scale = scale_of(system_, at_rest_).scale;
  const MatX along = weights_.asDiagonal() * (scale.asDiagonal() * tangent_of(statics_, scale).free);
  if (along.cols() == 0) return along;
  const MatX free = solve_lower(along.transpose() * along, along.transpose()).transpose();
  const auto count = static_cast<Eigen::Index>(leg_.moved.directions().size());
  if (count == 0) return free;
  MatX moved(free.cols(), count);
  for (Eigen::Index i = 0; i < count; ++i)
    moved.col(i) = free.transpose() * Eigen::Map<const VecX>(leg_.moved.directions()[static_cast<std::size_t>(i)].data(), free.rows());
  if (!(moved.colwise().norm().maxCoeff() > k_part_of_motion)) return free;
  return free * PivotedQr(moved, k_part_of_motion).complement();
}

FrozenGrowth FrozenLeg::growth_at(const State& state, double least) {
  const OneThread alone;
  linearise(state);
  const MatX z = unmoved_directions();
  if (z.cols() == 0) return {};
  const MatX unweighted = weights_.cwiseInverse().asDiagonal() * z;
  const MatX stiffness = statics_.stiffness(lambda_);
  const MatX a = unweighted.transpose() * stiffness * unweighted, b = unweighted.transpose() * statics_.damping() * unweighted;
  const MatX a_symmetric = symmetric_part(a), b_symmetric = symmetric_part(b);
  if (is_positive_definite(at_rate(a_symmetric, b_symmetric, least))) return {};
  const bool is_skew = (a - a.transpose()).cwiseAbs().sum() > k_skew * a.cwiseAbs().sum();
  const MatX size = stiffness.cwiseAbs();
  Fastest fastest;
  if (is_skew) {
    const double rounding = k_rounded_terms * k_epsilon * (unweighted.cwiseAbs().transpose() * size * unweighted.cwiseAbs()).trace();
    fastest = fastest_of_skew(a, b, rounding);
  } else {
    fastest = fastest_of_symmetric(a_symmetric, b_symmetric, least);
  }
  if (!(fastest.rate > least)) return {};
  const VecX shape = (z * fastest.eta).normalized();
  // Growth is pushed by a negative stiffness, which has to be more than rounding of the terms it is the sum of.
  const VecX place = weights_.cwiseInverse().cwiseProduct(shape);
  const double rounding = k_epsilon * (k_rounded_terms * place.cwiseAbs().dot(size * place.cwiseAbs()) + 4.0 * a.cwiseAbs().maxCoeff());
  if (!(place.dot(stiffness * place) > rounding)) return {};
  return {fastest.rate, shape};
}

} // namespace steplap
