// Decompositions of dense matrices, each compiled in one place. Eigen's are templates: a file that uses one of them compiles it
// anew, which takes from three (LU) to fifteen seconds (eigenvalues). Whoever needs one calls it here and includes none of Eigen's
// headers but Core.
//
// All allocate unless said otherwise: nothing here but DenseLu::factor and solve of a size seen before is for a step.
#pragma once

#include "mbd/base/types.h"

#include <memory>
#include <utility>
#include <vector>

namespace steplap {

/// a = Q R with as many columns of Q as asked for; R has as many rows as a has columns.
struct Qr {
  MatX q, r;
};
[[nodiscard]] Qr qr_of(const MatX& a, Eigen::Index columns_of_q);
/// The first columns of Q alone.
[[nodiscard]] MatX orthonormal(const MatX& a, Eigen::Index columns);

/// a Π = Q R, each column of a at the place where it is the longest beyond those before it. Takes matrices without rows or columns.
class PivotedQr {
public:
  /// Columns that are beyond the others by less than `threshold` of the longest depend on them; as rounding has it if it is 0.
  explicit PivotedQr(const MatX& a, double threshold = 0.0);
  ~PivotedQr();
  PivotedQr(const PivotedQr&) = delete;
  PivotedQr& operator=(const PivotedQr&) = delete;

  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  [[nodiscard]] int column(Eigen::Index place) const;
  /// |R_ii|, length of the i-th column beyond those before.
  [[nodiscard]] double length(Eigen::Index place) const;
  [[nodiscard]] MatX q(Eigen::Index columns) const;
  /// What no column reaches: orthonormal.
  [[nodiscard]] MatX complement() const;
  /// Null vectors of a, each with the only entry of one of the columns ("pivot"); entries below `least` are zero.
  struct NullSpace {
    MatX vectors;
    std::vector<int> pivots;
  };
  [[nodiscard]] NullSpace null_space(double least) const;
  /// x of the columns that span what there is with a x = right, as nearly as can be: of rank() columns, zero elsewhere.
  [[nodiscard]] MatX solve_by_rank(const MatX& right) const;
  /// The same with every column that is not exactly zero beyond the others.
  [[nodiscard]] MatX solve(const MatX& right) const;

private:
  struct Factor;
  Eigen::Index rows_, cols_, rank_ = 0;
  std::unique_ptr<Factor> factor_;
};

/// x with a x = b as nearly as can be, by a Q R with pivots.
[[nodiscard]] VecX least_squares(const MatX& a, const VecX& b);
/// Of a x = b by Q R: R and as many rows of Qᵀ b as it has.
[[nodiscard]] std::pair<MatX, VecX> triangle_of(const MatX& a, const VecX& b);
/// The shortest of them; rows and columns that are beyond the others by less than `threshold` of the longest depend on them.
[[nodiscard]] VecX shortest_solution(const MatX& a, const VecX& b, double threshold);
/// By Q R without pivots: what an LU asks of the C library (cabs) hangs on the processor.
[[nodiscard]] Eigen::VectorXcd solve_complex(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& b);

/// a = L Lᵀ: L⁻¹ right.
[[nodiscard]] MatX solve_lower(const MatX& a, const MatX& right);
/// a = Lᵀ D L with pivots, a symmetric.
[[nodiscard]] VecX solve_symmetric(const MatX& a, const VecX& right);
[[nodiscard]] MatX solve_symmetric(const MatX& a, const MatX& right);

/// Π a = L U. Nothing allocates where a matrix of the same size was factored before.
class DenseLu {
public:
  DenseLu();
  explicit DenseLu(const MatX& a);
  ~DenseLu();
  DenseLu(DenseLu&&) noexcept;
  DenseLu& operator=(DenseLu&&) noexcept;

  void factor(const MatX& a);
  [[nodiscard]] double least_pivot() const;     ///< |U_ii|
  void solve(const VecX& right, VecX& x) const; ///< two vectors
  [[nodiscard]] VecX solve(const VecX& right) const;
  [[nodiscard]] VecX solve_transposed(const VecX& right) const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// a x = right for several in turn, a of any rank: Π a Π' = L U.
class RankLu {
public:
  explicit RankLu(const MatX& a);
  ~RankLu();
  RankLu(const RankLu&) = delete;
  RankLu& operator=(const RankLu&) = delete;
  [[nodiscard]] MatX solve(const MatX& right) const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// Of a symmetric matrix; values in increasing order, vectors orthonormal.
struct SymmetricEigen {
  VecX values;
  MatX vectors;
};
[[nodiscard]] SymmetricEigen symmetric_eigen(const MatX& a);
/// Of any square one.
struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  bool is_converged = false;
};
[[nodiscard]] Eigenpairs eigenpairs(const MatX& a);
[[nodiscard]] Eigen::VectorXcd eigenvalues(const MatX& a);

/// a = U Σ Vᵀ: singular values in decreasing order and V with a column for each of them, by Jacobi's rotations (Eigen's other way
/// takes 20 s more of compiling, is quicker from some hundred columns on and less exact for small values).
struct RightSingular {
  VecX values;
  MatX v;
};
[[nodiscard]] RightSingular right_singular(const MatX& a);

} // namespace steplap
