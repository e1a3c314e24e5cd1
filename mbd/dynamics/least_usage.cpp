#include "mbd/dynamics/least_usage.h"

#include "mbd/base/decompositions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Relative difference of upper and lower bound that counts as zero, as the rounding error of sums of a few terms.
constexpr double k_gap = 4e-15;
// Limits on the number of simplex iterations. For curved sets each cutting plane reduces the error by a constant factor; for intervals a
// few iterations per unknown suffice.
constexpr int k_max_pivots_per_unknown = 60, k_max_pivots = 200;
// Fraction of the largest capacity that replaces a capacity of zero.
constexpr double k_least_capacity = 1e-13;
// Capacities above k_unlimited are those of elements without bound. They are replaced by k_most_capacity times the largest bounded one, or
// times the load if that is larger.
constexpr double k_unlimited = 1e20, k_most_capacity = 1e6;
constexpr double k_tiny = 1e-30;
// Weights of normals below this count as zero. The simplex basis is then degenerate.
constexpr double k_no_weight = 1e-12;

// Returns the capacity of a row in the direction of `wrench`; that of a freewheel depends on the sign. `capacity` has three blocks with one
// number per row: the larger of both capacities, that for negative wrenches, that for positive ones.
double capacity_towards(const VecX& capacity, Eigen::Index row, double wrench) {
  const Eigen::Index count = capacity.size() / 3;
  return capacity[(wrench < 0.0 ? 1 : 2) * count + row];
}

} // namespace

LeastUsage::LeastUsage(std::vector<int> dimension, MatX basis, std::vector<int> pivots, std::vector<double> length)
    : dimension_(std::move(dimension)), pivots_(std::move(pivots)), length_(std::move(length)), basis_(std::move(basis)) {
  int first = 0;
  for (const int d : dimension_) {
    first_.push_back(first);
    first += d;
  }
  const Eigen::Index rows = basis_.rows(), k = basis_.cols();
  capacity_.setZero(3 * rows); // see capacity_towards()
  best_.setZero(rows);
  rates_.setZero(rows);
  trial_.setZero(rows);
  z_.setZero(k);
  settled_.setZero(k);
  columns_.setZero(k + 1, k + 1);
  normals_.resize(k + 1);
}

double LeastUsage::gauge(const Gauges& gauges, const VecX& wrench, Normal& normal) const {
  const int row = first_[normal.part];
  if (dimension_[normal.part] > 1) return gauges.gauge(normal.part, wrench.data() + row, normal.n);
  const double inverse = length_[row] / capacity_towards(capacity_, row, wrench[row]);
  normal.n[0] = std::copysign(inverse, wrench[row]);
  return inverse * std::abs(wrench[row]);
}

// Returns the support function of an element at its present slip rates.
double LeastUsage::support(const Gauges& gauges, std::size_t part) const {
  const int row = first_[part];
  if (dimension_[part] > 1) return gauges.support(static_cast<int>(part), rates_.data() + row);
  return capacity_towards(capacity_, row, -rates_[row]) / length_[row] * std::abs(rates_[row]);
}

// Returns the largest gauge of all elements at `wrench`, and its normal.
double LeastUsage::largest(const Gauges& gauges, const VecX& wrench, Normal& normal) const {
  double worst = -1.0;
  for (std::size_t p = 0; p < dimension_.size(); ++p) {
    Normal own;
    own.part = static_cast<int>(p);
    const double g = gauge(gauges, wrench, own);
    if (g <= worst) continue;
    worst = g;
    normal = own;
  }
  return worst;
}

// Distributes the load such that Σ λ_r²/(c_r l_r) is least over z, with capacities c_r and lengths l_r. The gradient by λ is a slip
// mechanism. If all elements move as one rigid body, it is the mechanism that limits the load.
void LeastUsage::share_by_capacity(const Gauges& gauges, const VecX& wrench) {
  for (std::size_t p = 0; p < dimension_.size(); ++p)
    for (int r = 0; r < dimension_[p]; ++r) {
      double rate[3] = {0, 0, 0};
      rate[r] = 1.0;
      const Eigen::Index row = first_[p] + r, count = basis_.rows();
      capacity_[count + row] = capacity_[2 * count + row] = gauges.support(static_cast<int>(p), rate);
      rate[r] = -1.0;
      if (dimension_[p] == 1) capacity_[2 * count + row] = gauges.support(static_cast<int>(p), rate);
    }
  const Eigen::Index count = basis_.rows();
  scale_ = k_tiny;
  for (const double capacity : capacity_.tail(2 * count)) {
    const double size = capacity < k_unlimited ? capacity : wrench.cwiseAbs().maxCoeff();
    scale_ = std::max(scale_, size);
  }
  for (Eigen::Index r = 0; r < count; ++r) {
    for (const Eigen::Index side : {count, 2 * count})
      capacity_[side + r] = length_[r] * std::max(std::min(capacity_[side + r], k_most_capacity * scale_), k_least_capacity * scale_);
    capacity_[r] = std::max(capacity_[count + r], capacity_[2 * count + r]);
  }
  weighted_ = capacity_.head(count).cwiseInverse().asDiagonal() * basis_;
  normal_matrix_ = basis_.transpose() * weighted_;
  settled_ = solve_symmetric(normal_matrix_, VecX(-(weighted_.transpose() * wrench)));
  trial_ = wrench + basis_ * settled_;
}

// Returns the kinematic lower bound of u for this mechanism: power of the load over the largest power that friction can dissipate.
double LeastUsage::bound_of_mechanism(const Gauges& gauges, const VecX& wrench) {
  rates_ = trial_.cwiseQuotient(capacity_.head(trial_.size()));
  VecX taken(static_cast<Eigen::Index>(dimension_.size()));
  for (std::size_t p = 0; p < dimension_.size(); ++p) taken[static_cast<Eigen::Index>(p)] = support(gauges, p);
  const double all = taken.sum();
  for (std::size_t p = 0; p < dimension_.size(); ++p)
    if (taken[static_cast<Eigen::Index>(p)] < k_no_weight * all) rates_.segment(first_[p], dimension_[p]).setZero();
  rates_ /= all;
  return rates_.dot(wrench);
}

void LeastUsage::put_column(const Normal& normal, double* column) const {
  const Eigen::Index k = basis_.cols();
  for (Eigen::Index j = 0; j < k; ++j) column[j] = 0.0;
  for (int r = 0; r < dimension_[normal.part]; ++r)
    for (Eigen::Index j = 0; j < k; ++j) column[j] += scale_ * normal.n[r] * basis_(first_[normal.part] + r, j);
  column[k] = 1.0;
}

// Starts the simplex method: two opposite normals of the first pivot row and one normal of each other pivot row. This basis is feasible,
// with all weight on the first two.
void LeastUsage::start_basis(const VecX& wrench) {
  const auto k = static_cast<std::size_t>(basis_.cols());
  for (std::size_t i = 0; i <= k; ++i) {
    const int row = pivots_[i < k ? i : 0];
    const auto after = std::upper_bound(first_.begin(), first_.end(), row);
    Normal& normal = normals_[i];
    normal = {};
    normal.part = static_cast<int>(after - first_.begin()) - 1;
    const double side = (wrench[row] < 0.0) == (i < k) ? -1.0 : 1.0;
    normal.n[row - first_[normal.part]] = side * length_[row] / capacity_towards(capacity_, row, side);
    put_column(normal, columns_.col(static_cast<Eigen::Index>(i)).data());
  }
}

void LeastUsage::set_rates(const VecX& weight) {
  rates_.setZero();
  for (std::size_t i = 0; i < normals_.size(); ++i) {
    const double y = weight[static_cast<Eigen::Index>(i)];
    if (y < k_no_weight) continue;
    for (int r = 0; r < dimension_[normals_[i].part]; ++r) rates_[first_[normals_[i].part] + r] += y * normals_[i].n[r];
  }
}

void LeastUsage::improve(const Gauges& gauges, const VecX& wrench) {
  const Eigen::Index k = basis_.cols();
  const int most = k_max_pivots + k_max_pivots_per_unknown * static_cast<int>(k);
  VecX cost(k + 1), right = VecX::Zero(k + 1), weight, step, entering(k + 1);
  right[k] = 1.0;
  for (int pivot = 0; pivot < most; ++pivot) {
    const DenseLu lu(columns_);
    weight = lu.solve(right);
    for (Eigen::Index i = 0; i <= k; ++i) {
      const Normal& normal = normals_[static_cast<std::size_t>(i)];
      cost[i] = 0.0;
      for (int r = 0; r < dimension_[normal.part]; ++r) cost[i] += normal.n[r] * wrench[first_[normal.part] + r];
    }
    const VecX dual = lu.solve_transposed(cost);
    const double value = dual[k];
    if (!dual.allFinite()) return;
    if (value > lower_) {
      lower_ = value;
      set_rates(weight);
    }
    const VecX z = -scale_ * dual.head(k);
    trial_ = wrench + basis_ * z;
    Normal next;
    const double worst = largest(gauges, trial_, next);
    if (worst < usage_) {
      usage_ = worst;
      best_ = trial_;
      z_ = z;
    }
    if (worst - value <= k_gap * worst || usage_ - lower_ <= k_gap * usage_) return;
    put_column(next, entering.data());
    step = lu.solve(entering);
    Eigen::Index leaving = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i <= k; ++i) {
      if (!(step[i] > k_no_weight)) continue;
      const double ratio = std::max(weight[i], 0.0) / step[i];
      if (ratio < least) {
        least = ratio;
        leaving = i;
      }
    }
    if (leaving < 0) return;
    normals_[static_cast<std::size_t>(leaving)] = next;
    columns_.col(leaving) = entering;
  }
}

void LeastUsage::solve(const Gauges& gauges, const VecX& wrench) {
  share_by_capacity(gauges, wrench);
  Normal unused;
  const double shared = largest(gauges, trial_, unused);
  usage_ = shared;
  best_ = trial_;
  z_ = settled_;
  lower_ = 0.0;
  rates_.setZero();
  if (usage_ <= k_surely_holds) return;
  lower_ = bound_of_mechanism(gauges, wrench);
  if (usage_ - lower_ <= k_gap * usage_) return;
  start_basis(trial_);
  improve(gauges, wrench);
  if (shared <= 1.0) return;
  // Gauges are convex, so the largest gauge is at most 1 at this fraction of the way towards the optimum.
  const double excess = shared - usage_, wanted = shared - 1.0;
  const double part = excess > wanted ? wanted / excess : 1.0;
  settled_ += part * (z_ - settled_);
}

} // namespace steplap
