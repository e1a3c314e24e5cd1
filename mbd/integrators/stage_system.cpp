#include "mbd/integrators/stage_system.h"

#include <cmath>

namespace steplap {

void StageSystem::set(const Linearization& linearization, const Layout& layout) {
  linearization_ = &linearization;
  n_ = linearization.coordinates();
  m_ = linearization.rows();
  is_dense_ = n_ + m_ <= k_max_dense;
  is_redundant_.assign(m_, 0);
  if (layout.schur.is_singular())
    for (int r = 0; r < m_; ++r) is_redundant_[r] = layout.schur.is_dependent(r) ? 1 : 0;
  right_.resize(n_ + m_);
  solution_.resize(n_ + m_);
  moved_.resize(n_);
}

template <class Put> void StageSystem::assemble(double g, const Put& put) const {
  const std::vector<double>& w = linearization_->inverse_mass();
  for (int i = 0; i < n_; ++i) put(i, i, 1.0);
  for (const auto& e : linearization_->stiffness()) put(e.row(), e.col(), -g * g * w[e.row()] * e.value());
  for (const auto& e : linearization_->damping()) put(e.row(), e.col(), -g * w[e.row()] * e.value());
  const auto put_row = [&](const Linearization::Triplet& e, double value) {
    put(n_ + e.row(), e.col(), is_redundant_[e.row()] ? 0.0 : value);
  };
  for (const auto& e : linearization_->gradient()) {
    put_row(e, e.value());
    put(e.col(), n_ + e.row(), is_redundant_[e.row()] ? 0.0 : -w[e.col()] * e.value());
  }
  for (const auto& e : linearization_->bias_by_pose()) put_row(e, -g * g * e.value());
  for (const auto& e : linearization_->bias_by_velocity()) put_row(e, -g * e.value());
  for (int r = 0; r < m_; ++r) put(n_ + r, n_ + r, is_redundant_[r] ? 1.0 : 0.0);
}

bool StageSystem::factor(double g) {
  g_ = g;
  if (is_dense_) {
    matrix_.setZero(n_ + m_, n_ + m_);
    assemble(g, [this](int i, int j, double value) { matrix_(i, j) += value; });
    if (!matrix_.allFinite()) return false;
    dense_.compute(matrix_);
    return dense_.matrixLU().diagonal().cwiseAbs().minCoeff() > 0.0;
  }
  entries_.clear();
  bool is_finite = true;
  assemble(g, [&](int i, int j, double value) {
    is_finite = is_finite && std::isfinite(value);
    entries_.emplace_back(i, j, value);
  });
  if (!is_finite) return false;
  sparse_matrix_.resize(n_ + m_, n_ + m_);
  sparse_matrix_.setFromTriplets(entries_.begin(), entries_.end());
  std::vector<int> pattern(sparse_matrix_.outerIndexPtr(), sparse_matrix_.outerIndexPtr() + n_ + m_ + 1);
  pattern.insert(pattern.end(), sparse_matrix_.innerIndexPtr(),
                 sparse_matrix_.innerIndexPtr() + sparse_matrix_.nonZeros());
  if (pattern != pattern_) {
    sparse_.analyzePattern(sparse_matrix_);
    pattern_ = std::move(pattern);
  }
  sparse_.factorize(sparse_matrix_);
  return sparse_.info() == Eigen::Success;
}

void StageSystem::solve(const double* r, double* u) {
  const std::vector<double>& w = linearization_->inverse_mass();
  const double* const r_v = r + n_;
  moved_.setZero();
  for (const auto& e : linearization_->stiffness()) moved_[e.row()] += e.value() * r[e.col()];
  for (int i = 0; i < n_; ++i) right_[i] = g_ * (r_v[i] + g_ * w[i] * moved_[i]);
  right_.tail(m_).setZero();
  for (const auto& e : linearization_->gradient()) right_[n_ + e.row()] += g_ * e.value() * r_v[e.col()];
  for (const auto& e : linearization_->bias_by_pose())
    right_[n_ + e.row()] += g_ * g_ * e.value() * r[e.col()];
  for (int i = 0; i < m_; ++i)
    if (is_redundant_[i]) right_[n_ + i] = 0.0;
  if (is_dense_) solution_.noalias() = dense_.solve(right_);
  else solution_ = sparse_.solve(right_);
  for (int i = 0; i < n_; ++i) {
    u[n_ + i] = solution_[i];
    u[i] = g_ * (r[i] + (w[i] > 0.0 ? solution_[i] : 0.0)); // a locked coordinate has a rate of its own
  }
}

} // namespace steplap
