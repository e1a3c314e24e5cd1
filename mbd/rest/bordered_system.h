// Solver for sparse symmetric equations with constraint rows: the response x of a matrix A to forces f, subject to J x = r, with
// multipliers y.
//
//   [ A + σ D   Jᵀ ] [x]   [f]
//   [ J         0  ] [y] = [r]
//
// The matrix is factorised as L Δ Lᵀ without pivoting, in a sparse order: bodies by least degree, each row after the first body on which it
// acts, so that no pivot consists of a row alone. To ensure non-zero pivots, ρ JᵀJ is added to A (without effect if J x = r), and the zero
// in dependent rows is replaced by −δ; iterative refinement removes the effect of δ. By Sylvester's law, the number of negative pivots
// minus the number of rows is the number of directions with J x = 0 in which A + σ D is negative. The cost of a body is proportional to the
// number of its joints.
#pragma once

#include "mbd/system/roles.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace steplap {

/// Constraint row: coefficients at the coordinates of bodies, three for each body, in the order of bodies. Initially there is space for two
/// bodies.
struct SparseRow {
  int count = 0;
  std::vector<int> at = std::vector<int>(6, 0);
  std::vector<double> j = std::vector<double>(6, 0.0);

  void add(int coordinate, double value) {
    if (count == static_cast<int>(at.size())) {
      at.resize(2 * at.size());
      j.resize(at.size());
    }
    at[count] = coordinate;
    j[count++] = value;
  }
  /// Adds `value` to the coefficient at `coordinate`. The coefficient exists already if several parts of the row act on the same body.
  void merge(int coordinate, double value) {
    const auto end = at.begin() + count, known = std::find(at.begin(), end, coordinate);
    if (known == end) add(coordinate, value);
    else j[known - at.begin()] += value;
  }

  [[nodiscard]] double dot(const VecX& x) const {
    double sum = 0.0;
    for (int k = 0; k < count; ++k) sum += j[k] * x[at[k]];
    return sum;
  }
};
/// Returns Jᵀ y.
[[nodiscard]] VecX pull_of(const std::vector<SparseRow>& rows, const VecX& y, Eigen::Index n);

class BorderedSystem {
public:
  using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  /// Sets the matrices. The largest entries of A should be of order 1, and A must have both triangles; rows must have unit length;
  /// `diagonal` is D.
  void set(const Sparse& a, const std::vector<SparseRow>& rows, const VecX& diagonal);
  /// Factorises the system with A + σ D. Returns false if a pivot vanishes.
  bool factor(double sigma);
  /// Returns the number of directions with J x = 0 in which A + σ D is negative, at the last factor().
  [[nodiscard]] int negative() const { return negative_; }
  /// Solves for x, and for y unless it is null. `off` is r; null: zero. Returns false if the iterative refinement does not converge.
  bool solve(const VecX& f, VecX& x, VecX* y = nullptr, const VecX* off = nullptr) const;

private:
  void find_order(const Sparse& a, const std::vector<SparseRow>& rows);
  void find_slots(const Sparse& a, const std::vector<SparseRow>& rows);
  template <class F> void for_entries(const Sparse& a, const std::vector<SparseRow>& rows, const F& f) const;

  Eigen::Index n_ = 0, m_ = 0;
  std::vector<int> place_;       ///< position in the elimination order of each coordinate, then of each row
  Sparse whole_;                 ///< upper triangle of the matrix in that order
  std::vector<double> diagonal_; ///< diagonal at coordinates, without σ D
  std::vector<int> slot_;        ///< index of each diagonal entry in whole_
  std::vector<int> pattern_;     ///< non-zero pattern of A and rows for which the elimination order was determined
  std::vector<int> entry_slot_;  ///< index in whole_ of each entry in turn
  VecX shift_by_;
  double delta_ = 0.0;
  int negative_ = 0;
  Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> factors_;
};

} // namespace steplap
