// Decompositions of dense matrices (QR, LU, Cholesky, eigenvalues, singular values), as wrappers of Eigen.
//
// Eigen's decompositions are templates, and each file that uses one takes three (LU) to fifteen seconds (eigenvalues) longer to compile.
// They are therefore compiled once, here; other files include only Eigen/Core.
//
// All functions allocate memory, except DenseLu::factor() and DenseLu::solve(right, x) for a size that was factored before. Only these two
// may be used inside a time step.
#pragma once

#include "mbd/base/types.h"

#include <memory>
#include <utility>
#include <vector>

namespace steplap {

/// Thin QR decomposition a = Q R. Q has the requested number of columns, R is square with as many rows as a has columns.
struct Qr {
  MatX q, r;
};
/// Returns the decomposition of a, with `columns_of_q` columns in Q.
[[nodiscard]] Qr qr_of(const MatX& a, Eigen::Index columns_of_q);
/// Returns only the first `columns` columns of Q.
[[nodiscard]] MatX orthonormal(const MatX& a, Eigen::Index columns);

/// QR decomposition with column pivoting, a Π = Q R, |R_ii| not increasing. Also accepts matrices without rows or columns.
class PivotedQr {
public:
  /// The rank is the number of |R_ii| > `threshold` · max |R_ii|. Threshold 0: Eigen's default, a few roundings.
  explicit PivotedQr(const MatX& a, double threshold = 0.0);
  ~PivotedQr();
  PivotedQr(const PivotedQr&) = delete;
  PivotedQr& operator=(const PivotedQr&) = delete;

  [[nodiscard]] Eigen::Index rank() const { return rank_; }
  /// Returns the index in a of the column that was chosen as pivot number `place`.
  [[nodiscard]] int column(Eigen::Index place) const;
  /// Returns |R_ii| for i = `place`: the distance of that column from the span of the columns chosen before it.
  [[nodiscard]] double length(Eigen::Index place) const;
  /// Returns the first `columns` columns of Q.
  [[nodiscard]] MatX q(Eigen::Index columns) const;
  /// Returns an orthonormal basis of the orthogonal complement of the columns of a: rows × (rows − rank).
  [[nodiscard]] MatX complement() const;
  /// Basis of the null space of a, cols × (cols − rank). Vector j has 1 at its own column pivots[j] and 0 at those of the other vectors;
  /// entries with absolute values below `least` are set to zero.
  struct NullSpace {
    MatX vectors;
    std::vector<int> pivots;
  };
  /// Returns the null space; entries below `least` are set to zero.
  [[nodiscard]] NullSpace null_space(double least) const;
  /// Returns a solution x of a x ≈ right (least squares) that uses only the rank() pivot columns; other entries of x are zero.
  [[nodiscard]] MatX solve_by_rank(const MatX& right) const;
  /// Returns a least-squares solution x of a x ≈ right that uses all columns with a nonzero pivot, however small.
  [[nodiscard]] MatX solve(const MatX& right) const;

private:
  struct Factor;
  Eigen::Index rows_, cols_, rank_ = 0;
  std::unique_ptr<Factor> factor_;
};

/// Returns the least-squares solution x of a x = b by QR with column pivoting.
[[nodiscard]] VecX least_squares(const MatX& a, const VecX& b);
/// Reduces the least-squares problem a x = b, a with n columns, to R x = c. Returns R (n × n) and c, the first n rows of Qᵀ b.
[[nodiscard]] std::pair<MatX, VecX> triangle_of(const MatX& a, const VecX& b);
/// Returns the least-squares solution of minimum norm. The rank is determined with `threshold` relative to the largest pivot.
[[nodiscard]] VecX shortest_solution(const MatX& a, const VecX& b, double threshold);
/// Solves a square complex system by QR without pivoting. LU is not used: its pivot search calls cabs of the C library, whose last bit
/// depends on the processor.
[[nodiscard]] Eigen::VectorXcd solve_complex(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& b);

/// Returns L⁻¹ right, with a = L Lᵀ the Cholesky decomposition of a symmetric positive definite matrix.
[[nodiscard]] MatX solve_lower(const MatX& a, const MatX& right);
/// Returns a⁻¹ right for symmetric a, by LDLᵀ with pivoting.
[[nodiscard]] VecX solve_symmetric(const MatX& a, const VecX& right);
/// Returns a⁻¹ right for symmetric a, with one right-hand side per column.
[[nodiscard]] MatX solve_symmetric(const MatX& a, const MatX& right);

/// LU decomposition with row pivoting, Π a = L U, of a square regular matrix. factor() and solve(right, x) do not allocate if a matrix of
/// the same size was factored before.
class DenseLu {
public:
  DenseLu();
  /// Factorises a.
  explicit DenseLu(const MatX& a);
  ~DenseLu();
  DenseLu(DenseLu&&) noexcept;
  DenseLu& operator=(DenseLu&&) noexcept;

  /// Factorises a in place of the previous matrix.
  void factor(const MatX& a);
  [[nodiscard]] double least_pivot() const;     ///< min |U_ii|; infinite for an empty matrix
  void solve(const VecX& right, VecX& x) const; ///< x = a⁻¹ right; `right` and `x` must be different vectors
  [[nodiscard]] VecX solve(const VecX& right) const;
  /// Returns a⁻ᵀ right.
  [[nodiscard]] VecX solve_transposed(const VecX& right) const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// LU decomposition with full pivoting, Π a Π' = L U, for matrices of any rank. solve() may be called repeatedly.
class RankLu {
public:
  /// Factorises a.
  explicit RankLu(const MatX& a);
  ~RankLu();
  RankLu(const RankLu&) = delete;
  RankLu& operator=(const RankLu&) = delete;
  [[nodiscard]] MatX solve(const MatX& right) const;

private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

/// Eigenvalues of a symmetric matrix in ascending order, and orthonormal eigenvectors (columns).
struct SymmetricEigen {
  VecX values;
  MatX vectors;
};
/// Returns the eigenvalues and eigenvectors of a symmetric matrix.
[[nodiscard]] SymmetricEigen symmetric_eigen(const MatX& a);
/// Eigenvalues and eigenvectors of a general square matrix; valid only if `is_converged`.
struct Eigenpairs {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
  bool is_converged = false;
};
/// Returns the eigenvalues and eigenvectors of a square matrix.
[[nodiscard]] Eigenpairs eigenpairs(const MatX& a);
[[nodiscard]] Eigen::VectorXcd eigenvalues(const MatX& a);

/// Singular values in decreasing order and the right singular vectors V of a = U Σ Vᵀ, one column for each value. Jacobi's rotations are
/// used rather than bidiagonalisation: they compute small singular values more accurately and compile 20 s faster; they are slower from
/// some hundred columns on.
struct RightSingular {
  VecX values;
  MatX v;
};
/// Returns the singular values and right singular vectors of a.
[[nodiscard]] RightSingular right_singular(const MatX& a);

} // namespace steplap
