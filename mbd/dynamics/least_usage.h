// The least overloaded way to share a load: among all wrenches λ + N z that carry the same load, those whose
// largest share of a capacity is least,
//   u = min_z max_e g_e(λ_e + N_e z),
// g_e the gauge of the convex set that part e can bear. As long as u ≤ 1 some admissible sharing exists, and the
// parts hold together whatever the single sharings are (static theorem of limit analysis; W. Prager, P. G. Hodge,
// Theory of Perfectly Plastic Solids, 1951). Where u passes 1 they give way, along the mechanism that the dual
// solution is:
//   u = max Σ y_i n_i·λ  over y ≥ 0, Σ y_i = 1, Σ y_i N_eᵀ n_i = 0,   n_i supporting normals of the gauges,
// with the slip rates Σ y_i n_i of each part, which N does no work on.
//
// Revised simplex method on the dual: a basis of k + 1 normals, the next one where a gauge is largest at the
// present z. For intervals this ends at the exact answer; for curved sets it is Kelley's cutting-plane method,
// with certified bounds from both sides.
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// What the parts of a shared load can bear.
class Gauges {
public:
  virtual ~Gauges() = default;
  /// Support function: the largest power that an admissible wrench of `part` takes from `rate`.
  [[nodiscard]] virtual double support(int part, const double* rate) const = 0;
  /// Share of the capacity that `wrench` uses, and n with n·w ≤ share of w for any w, equal for `wrench`. Asked
  /// of parts of more than one dimension only.
  virtual double gauge(int part, const double* wrench, double* normal) const = 0;
};

class LeastUsage {
public:
  /// `dimension`: of each part's wrench, 1 or 3, one after the other in the rows. `basis`: rows × k, of full
  /// column rank; row pivots[j] of it has its only entry in column j. `length` per row, m: 1 for a force; that
  /// by which a couple counts as a force.
  LeastUsage(std::vector<int> dimension, MatX basis, std::vector<int> pivots, std::vector<double> length);

  /// For the sharing `wrench`, one value per row.
  void solve(const Gauges& gauges, const VecX& wrench);

  /// u; below k_surely_holds only an upper bound of it.
  [[nodiscard]] double usage() const { return usage_; }
  /// Certified lower bound of u.
  [[nodiscard]] double lower() const { return lower_; }
  /// The sharing that uses least, per row.
  [[nodiscard]] const VecX& wrench() const { return best_; }
  /// Its z. One may move on to any other.
  [[nodiscard]] const VecX& coefficients() const { return z_; }
  /// Slip rates of the mechanism that limits it, per row, scaled to dissipate 1; zero for what stays at rest.
  [[nodiscard]] const VecX& rates() const { return rates_; }
  /// A smooth sharing that is admissible as long as one exists: each wrench squared over its capacity, the
  /// least sum; where that overloads a part, moved towards wrench() as far as it takes. Returns its z.
  [[nodiscard]] const VecX& settled() const { return settled_; }

  static constexpr double k_surely_holds = 0.5;

private:
  struct Normal {
    int part = 0;
    double n[3] = {0, 0, 0};
  };
  void share_by_capacity(const Gauges& gauges, const VecX& wrench);
  double gauge(const Gauges& gauges, const VecX& wrench, Normal& normal) const;
  [[nodiscard]] double support(const Gauges& gauges, std::size_t part) const;
  double largest(const Gauges& gauges, const VecX& wrench, Normal& normal) const;
  [[nodiscard]] double bound_of_mechanism(const Gauges& gauges, const VecX& wrench);
  void start_basis(const VecX& wrench);
  void improve(const Gauges& gauges, const VecX& wrench);
  void put_column(const Normal& normal, double* column) const;
  void set_rates(const VecX& weight);

  std::vector<int> dimension_, first_, pivots_;
  std::vector<double> length_;
  MatX basis_;
  double usage_ = 0.0, lower_ = 0.0, scale_ = 1.0;
  VecX capacity_, best_, z_, rates_, settled_, trial_;
  std::vector<Normal> normals_; ///< of the simplex basis
  MatX columns_, normal_matrix_, weighted_;
};

} // namespace steplap
