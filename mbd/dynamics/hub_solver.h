// The constraint equations where many rows meet in one body: all that stands on one deck.
//
// There A = J W Jᵀ is full, and its factors cost the cube of the number of rows. But without the few bodies in which many rows
// meet, the *hubs*, hardly any two rows have to do with each other: A = B + U W Uᵀ with B of the other bodies alone and U, a few
// columns, what the rows see of the hubs. With z = W Uᵀ λ, the hubs' own answer to λ,
//
//   B λ + U z = r,    W⁻¹ z = Uᵀ λ,    so that    (W⁻¹ + Uᵀ B⁻¹ U) z = Uᵀ B⁻¹ r,    λ = B⁻¹ (r − U z),
//
// which costs as much as there are rows. Rows between hubs and the ground alone are zero in B: they stay, with z, in the small
// system at the end.
//
// B λ = r − U z loses as many digits as B is smaller than A. Rows that the hubs answer far more than the other bodies do, rows that
// are near to others once hubs are held, and rows that are left out are therefore not for this: their pivots would mean
// something else, too. SchurSolver takes its own way for them.
#pragma once

#include "mbd/dynamics/schur.h"

#include <array>
#include <memory>
#include <vector>

namespace steplap {

/// As SchurSolver, of which it is a part, for rows of which many meet in few bodies.
class HubSolver {
public:
  /// Null: there are no hubs, or too many.
  [[nodiscard]] static std::unique_ptr<HubSolver> of(const std::vector<SchurRow>& rows, int count);
  /// False: these numbers are not for it. Allocates nothing.
  [[nodiscard]] bool factor(const std::vector<SchurRow>& rows);
  /// In place: x = A⁻¹ x, after factor().
  void solve(double* x) const;
  /// No pivot of A is below this, as SchurSolver::smallest_pivot() counts them, if rows are eliminated in B's order and the outer ones last.
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
  std::vector<int> hub_of_;                             ///< per body: which hub it is, or −1
  std::vector<int> inner_, outer_;                      ///< rows with another body than hubs and the ground, and those without
  std::vector<SchurRow> numbers_;                       ///< of the inner rows, without the hubs
  SchurSolver solver_;                                  ///< B
  std::vector<double> seen_, moved_;                    ///< U and B⁻¹ U: a number for each inner row, column after column
  std::array<double, 3 * k_most_hubs> stiffness_{};     ///< W⁻¹; 1 of a locked coordinate, which nothing sees
  std::array<double, k_most_ends * k_most_ends> end_{}; ///< what is left, and its factors: z, then outer rows
  std::array<double, k_most_ends> inverse_d_{}, own_{}; ///< own: of an outer row, its entry of A
  std::array<std::array<double, 3 * k_most_hubs>, k_most_outer> outer_seen_{}; ///< U of the outer rows
  double smallest_pivot_ = 1.0;
  mutable std::vector<double> right_;
};

} // namespace steplap
