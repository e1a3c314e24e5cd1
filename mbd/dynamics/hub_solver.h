// Solver of the constraint equations for models in which many rows act on a few bodies, for example if all elements are on one deck.
//
// Such a body makes A = J W Jᵀ dense, and its factorisation costs O(rows³). These few bodies are called hubs. Without them, few rows are
// coupled: A = B + U W Uᵀ, where B is the matrix for the other bodies, and the few columns of U are the gradients by the coordinates of the
// hubs. With z = W Uᵀ λ, the accelerations of the hubs due to λ,
//
//   B λ + U z = r,    W⁻¹ z = Uᵀ λ,    so that    (W⁻¹ + Uᵀ B⁻¹ U) z = Uᵀ B⁻¹ r,    λ = B⁻¹ (r − U z),
//
// at a cost proportional to the number of rows. Rows that act only on hubs and the ground have zero entries in B. These "outer" rows are
// solved together with z in the small dense system at the end.
//
// The accuracy of B λ = r − U z decreases with the ratio of B to A. SchurSolver therefore solves for A itself if the hubs dominate the
// diagonal of a row, if rows become nearly dependent once the hubs are fixed, or if rows are left out.
#pragma once

#include "mbd/dynamics/schur.h"

#include <array>
#include <memory>
#include <vector>

namespace steplap {

/// Solver for rows many of which act on a few bodies; a part of SchurSolver.
class HubSolver {
public:
  /// Returns a solver for the first `count` rows; null if there are no hubs, or too many.
  [[nodiscard]] static std::unique_ptr<HubSolver> of(const std::vector<SchurRow>& rows, int count);
  /// Factorises the equations. Returns false if this method would be inaccurate for these rows. Does not allocate.
  [[nodiscard]] bool factor(const std::vector<SchurRow>& rows);
  /// Solves A x = x₀ in place. Precondition: factor() returned true.
  void solve(double* x) const;
  /// Returns a lower bound of all relative pivots of A (SchurSolver::smallest_pivot()) in the elimination order of B, with outer rows last.
  [[nodiscard]] double smallest_pivot() const { return smallest_pivot_; }

private:
  static constexpr int k_most_hubs = 4, k_most_outer = 8;
  static constexpr int k_most_ends = 3 * k_most_hubs + k_most_outer;

  explicit HubSolver(const std::vector<SchurRow>& rows, int count, const std::vector<int>& hub_of);
  [[nodiscard]] double take_numbers(const std::vector<SchurRow>& rows);
  void add_sides(const SchurRow& row, double* of_coordinates) const;
  void fill_end();
  [[nodiscard]] double eliminate_end();

  int hub_count_ = 0;
  std::vector<int> hub_of_;                             ///< per body: index of the hub, or −1
  std::vector<int> inner_, outer_;                      ///< inner_: rows that act on a body other than hubs and ground; outer_: all others
  std::vector<SchurRow> numbers_;                       ///< inner rows, with the ground in place of the hub
  SchurSolver solver_;                                  ///< B
  std::vector<double> seen_, moved_;                    ///< U and B⁻¹ U, one number per inner row, stored by columns
  std::array<double, 3 * k_most_hubs> stiffness_{};     ///< W⁻¹; 1 for a locked coordinate, whose column in U is zero
  std::array<double, k_most_ends * k_most_ends> end_{}; ///< dense system for z and the outer rows, and its factors
  std::array<double, k_most_ends> inverse_d_{}, own_{}; ///< own_: diagonal entries of A for outer rows
  std::array<std::array<double, 3 * k_most_hubs>, k_most_outer> outer_seen_{}; ///< U of the outer rows
  double smallest_pivot_ = 1.0;
  mutable std::vector<double> right_;
};

} // namespace steplap
