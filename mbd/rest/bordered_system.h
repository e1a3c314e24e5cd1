// Sparse equations with constraint rows: forces f against a symmetric A along rows J that are met.
//
//   [ A + σ D   Jᵀ ] [x]   [f]
//   [ J         0  ] [y] = [r]
//
// Factored as L Δ Lᵀ without pivoting, in an order that stays sparse: bodies in the order of least degree, each row after
// the first body it acts on, so that no pivot is made of a row alone. So that pivots are there at all, A is given ρ JᵀJ
// (which changes nothing where rows are met) and rows that depend on others −δ in place of 0; solutions are refined
// until δ is gone from them. By Sylvester's law the signs of Δ count: as many negative ones beyond the rows' as A + σ D
// has negative directions along J x = 0. A body with many joints costs no more than its number of joints.
#pragma once

#include "mbd/system/roles.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <vector>

namespace steplap {

/// A constraint row over the coordinates of its bodies, three each and in their order. Room for two bodies, as most have.
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
  /// Of a body that several parts of the row act on: to what is there of it.
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
/// Jᵀ y
[[nodiscard]] VecX pull_of(const std::vector<SparseRow>& rows, const VecX& y, Eigen::Index n);

class BorderedSystem {
public:
  using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

  /// A with its largest entries of order 1, both triangles; rows of length 1; D by its diagonal.
  void set(const Sparse& a, const std::vector<SparseRow>& rows, const VecX& diagonal);
  /// A + σ D; false where a pivot vanishes.
  bool factor(double sigma);
  /// Directions along the rows in which A + σ D is negative.
  [[nodiscard]] int negative() const { return negative_; }
  /// x, and y if asked for; false where refinement does not get there. `off`: r, zero without.
  bool solve(const VecX& f, VecX& x, VecX* y = nullptr, const VecX* off = nullptr) const;

private:
  void find_order(const Sparse& a, const std::vector<SparseRow>& rows);
  void find_slots(const Sparse& a, const std::vector<SparseRow>& rows);
  template <class F> void for_entries(const Sparse& a, const std::vector<SparseRow>& rows, const F& f) const;

  Eigen::Index n_ = 0, m_ = 0;
  std::vector<int> place_;       ///< of each coordinate, then of each row
  Sparse whole_;                 ///< upper triangle, in that order
  std::vector<double> diagonal_; ///< of coordinates, without σ D
  std::vector<int> slot_;        ///< of each diagonal entry in whole_
  std::vector<int> pattern_;     ///< of A and the rows that the order was made for
  std::vector<int> entry_slot_;  ///< in whole_, of each entry in turn
  VecX shift_by_;
  double delta_ = 0.0;
  int negative_ = 0;
  Eigen::SimplicialLDLT<Sparse, Eigen::Upper, Eigen::NaturalOrdering<int>> factors_;
};

} // namespace steplap
