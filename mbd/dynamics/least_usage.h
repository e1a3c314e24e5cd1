// Least utilisation of a statically indeterminate group of friction elements: among all wrenches λ + N z in equilibrium with the same load,
// those with the smallest maximal utilisation,
//
//   u = min_z max_e g_e(λ_e + N_e z),
//
// with g_e the gauge of the convex set of admissible wrenches of element e. For u ≤ 1 an admissible distribution exists, and the group
// sticks, whatever the actual distribution (static theorem of limit analysis; W. Prager, P. G. Hodge, Theory of Perfectly Plastic Solids,
// 1951). When u exceeds 1 the group slips in the mechanism given by the dual solution,
//
//   u = max Σ y_i n_i·λ  over y ≥ 0, Σ y_i = 1, Σ y_i N_eᵀ n_i = 0,   n_i supporting normals of the gauges,
//
// with slip rates Σ y_i n_i, on which the self-stresses N do no work.
//
// The dual is solved by the revised simplex method with a basis of k + 1 normals, k the number of columns of N; the entering normal is that
// of the largest gauge at the present z. For intervals this terminates with the exact solution; for curved sets it is Kelley's
// cutting-plane method with certified bounds from both sides.
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// Interface to the admissible sets of the elements of a group; `part` is the index of the element in the group.
class Gauges {
public:
  virtual ~Gauges() = default;
  /// Returns the support function of element `part`: max over admissible w of −w·rate.
  [[nodiscard]] virtual double support(int part, const double* rate) const = 0;
  /// Returns the gauge of `wrench` (1 on the boundary of the admissible set). Writes to `normal` a vector n with n·w ≤ gauge(w) for all w,
  /// with equality for `wrench`. Called only for elements of dimension > 1.
  virtual double gauge(int part, const double* wrench, double* normal) const = 0;
};

/// Least utilisation u of one group of elements, and the distribution of wrenches that attains it.
class LeastUsage {
public:
  /// `dimension`: 1 or 3 for each element; the rows of an element are consecutive. `basis`: N, rows × k, of full column rank; row pivots[j]
  /// of N is zero except in column j. `length`, m, for each row: 1 for a force; for the moment of an angle row the lever that converts it
  /// to a force.
  LeastUsage(std::vector<int> dimension, MatX basis, std::vector<int> pivots, std::vector<double> length);

  /// Computes u for the wrenches λ = `wrench`, one number for each row.
  void solve(const Gauges& gauges, const VecX& wrench);

  /// Returns u; if the result is below k_surely_holds, it is only an upper bound of u.
  [[nodiscard]] double usage() const { return usage_; }
  /// Returns a certified lower bound of u.
  [[nodiscard]] double lower() const { return lower_; }
  /// Returns the optimal wrenches λ + N z, per row.
  [[nodiscard]] const VecX& wrench() const { return best_; }
  /// Returns z of wrench(). Other admissible z are physically possible, too.
  [[nodiscard]] const VecX& coefficients() const { return z_; }
  /// Returns the slip rates of the limiting mechanism for each row, scaled to dissipate 1 W; zero for elements that do not slip in it.
  [[nodiscard]] const VecX& rates() const { return rates_; }
  /// Returns z of a distribution that depends smoothly on λ, and is admissible if any is. It is the distribution with least Σ
  /// wrench²/capacity, moved towards wrench() as far as necessary if it overloads an element.
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
  std::vector<Normal> normals_; ///< normals in the simplex basis
  MatX columns_, normal_matrix_, weighted_;
};

} // namespace steplap
