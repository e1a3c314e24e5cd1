// Orthogonal decompositions (QR, SVD), in one file because they share Eigen's Householder templates.
#include "mbd/base/decompositions.h"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>

namespace steplap {

Qr qr_of(const MatX& a, Eigen::Index columns_of_q) {
  const Eigen::HouseholderQR<MatX> qr(a);
  return {qr.householderQ() * MatX::Identity(a.rows(), columns_of_q), qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>()};
}

MatX orthonormal(const MatX& a, Eigen::Index columns) {
  const Eigen::HouseholderQR<MatX> qr(a);
  return qr.householderQ() * MatX::Identity(a.rows(), columns);
}

struct PivotedQr::Factor : Eigen::ColPivHouseholderQR<MatX> {
  using ColPivHouseholderQR::ColPivHouseholderQR;
};

// Eigen does not accept matrices without rows or columns, so these are treated separately.
PivotedQr::PivotedQr(const MatX& a, double threshold)
    : rows_(a.rows()), cols_(a.cols()),
      factor_(std::make_unique<Factor>(std::max<Eigen::Index>(rows_, 1), std::max<Eigen::Index>(cols_, 1))) {
  if (rows_ == 0 || cols_ == 0) return;
  if (threshold > 0.0) factor_->setThreshold(threshold);
  factor_->compute(a);
  rank_ = factor_->rank();
}

PivotedQr::~PivotedQr() = default;

int PivotedQr::column(Eigen::Index place) const { return factor_->colsPermutation().indices()[place]; }
double PivotedQr::length(Eigen::Index place) const { return std::abs(factor_->matrixQR()(place, place)); }

MatX PivotedQr::q(Eigen::Index columns) const {
  if (rank_ == 0) return MatX::Identity(rows_, columns);
  return factor_->householderQ() * MatX::Identity(rows_, columns);
}

MatX PivotedQr::complement() const { return q(rows_).rightCols(rows_ - rank_); }

PivotedQr::NullSpace PivotedQr::null_space(double least) const {
  const Eigen::Index k = cols_ - rank_;
  NullSpace found;
  MatX vectors = MatX::Zero(cols_, k);
  if (k > 0) vectors.bottomRows(k).setIdentity(); // for an empty matrix Eigen would compute an offset from a null pointer
  if (rank_ == 0) {
    for (Eigen::Index j = 0; j < k; ++j) found.pivots.push_back(static_cast<int>(j));
    found.vectors = vectors;
    return found;
  }
  if (k == 0) { // full column rank: the null space is {0}
    found.vectors = vectors;
    return found;
  }
  const MatX& r = factor_->matrixR();
  vectors.topRows(rank_) = -r.topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solve(r.topRightCorner(rank_, k));
  vectors = (vectors.array().abs() < least).select(0.0, vectors);
  found.vectors = factor_->colsPermutation() * vectors;
  for (Eigen::Index j = 0; j < k; ++j) found.pivots.push_back(column(rank_ + j));
  return found;
}

MatX PivotedQr::solve_by_rank(const MatX& right) const {
  MatX found = MatX::Zero(cols_, right.cols());
  if (rank_ == 0 || right.cols() == 0) return found;
  found.topRows(rank_) = factor_->matrixR()
                             .topLeftCorner(rank_, rank_)
                             .triangularView<Eigen::Upper>()
                             .solve((factor_->householderQ().transpose() * right).topRows(rank_));
  return factor_->colsPermutation() * found;
}

MatX PivotedQr::solve(const MatX& right) const { return factor_->solve(right); }

std::pair<MatX, VecX> triangle_of(const MatX& a, const VecX& b) {
  const Eigen::Index n = a.cols();
  const Eigen::HouseholderQR<MatX> qr(a);
  return {qr.matrixQR().topRows(n).triangularView<Eigen::Upper>(), VecX(qr.householderQ().adjoint() * b).head(n)};
}

VecX least_squares(const MatX& a, const VecX& b) { return a.colPivHouseholderQr().solve(b); }

VecX shortest_solution(const MatX& a, const VecX& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatX> factor(a.rows(), a.cols());
  factor.setThreshold(threshold);
  factor.compute(a);
  return factor.solve(b);
}

Eigen::VectorXcd solve_complex(const Eigen::MatrixXcd& a, const Eigen::VectorXcd& b) { return a.householderQr().solve(b); }

RightSingular right_singular(const MatX& a) {
  const Eigen::JacobiSVD<MatX> svd(a, Eigen::ComputeThinV);
  return {svd.singularValues(), svd.matrixV()};
}

} // namespace steplap
