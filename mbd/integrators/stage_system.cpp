#include "mbd/integrators/stage_system.h"

#include <algorithm>

namespace steplap {

void StageSystem::set(const Linearization& linearization, const Layout& layout) {
  linearization_ = &linearization;
  n_ = linearization.coordinates();
  m_ = linearization.rows();
  is_dense_ = n_ + m_ <= k_max_dense;
  is_redundant_.assign(m_, 0);
  if (layout.is_singular())
    for (int r = 0; r < m_; ++r) is_redundant_[r] = layout.is_dependent(r) ? 1 : 0;
  right_.resize(n_ + m_);
  solution_.resize(n_ + m_);
  moved_.resize(n_);
  position_shares_.reserve(static_cast<std::size_t>(n_));
  inner_.resize(linearization.inner().size());
  set_states();
}

// Collects the own states of the model and their coordinates. Repeated for every linearisation, because these lists change with the
// modes.
void StageSystem::set_states() {
  const Linearization::StateParts& parts = linearization_->states();
  const auto place_in = [](std::vector<int>& list, int number) {
    const auto at = std::find(list.begin(), list.end(), number);
    const auto place = static_cast<Eigen::Index>(at - list.begin());
    if (at == list.end()) list.push_back(number);
    return place;
  };
  states_.clear();
  state_columns_.clear();
  state_rows_.clear();
  for (const auto* list : {&parts.by_pose, &parts.by_velocity})
    for (const auto& e : *list) {
      (void)place_in(states_, e.row());
      (void)place_in(state_columns_, e.col());
    }
  for (const auto& e : parts.by_state) {
    (void)place_in(states_, e.row());
    (void)place_in(states_, e.col());
  }
  for (const auto& e : parts.forces) {
    (void)place_in(states_, e.col());
    (void)place_in(state_rows_, e.row());
  }
  const auto k = static_cast<Eigen::Index>(states_.size());
  state_pose_.setZero(k, static_cast<Eigen::Index>(state_columns_.size()));
  state_velocity_.setZero(k, static_cast<Eigen::Index>(state_columns_.size()));
  state_force_.setZero(static_cast<Eigen::Index>(state_rows_.size()), k);
  state_by_state_.setZero(k, k);
  for (const auto& e : parts.by_pose) state_pose_(place_in(states_, e.row()), place_in(state_columns_, e.col())) += e.value();
  for (const auto& e : parts.by_velocity) state_velocity_(place_in(states_, e.row()), place_in(state_columns_, e.col())) += e.value();
  for (const auto& e : parts.by_state) state_by_state_(place_in(states_, e.row()), place_in(states_, e.col())) += e.value();
  for (const auto& e : parts.forces) state_force_(place_in(state_rows_, e.row()), place_in(states_, e.col())) += e.value();
}

void StageSystem::factor_states() {
  const auto k = static_cast<Eigen::Index>(states_.size());
  if (k == 0) return;
  state_matrix_.setIdentity(k, k);
  state_matrix_ = state_matrix_ / g_ - state_by_state_;
  state_factors_.compute(state_matrix_);
  state_answer_ = state_factors_.inverse();
  state_way_ = g_ * state_pose_ + state_velocity_;
  state_reply_.noalias() = state_force_ * state_answer_;
  state_damping_.noalias() = state_reply_ * state_way_;
}

void StageSystem::add_state_forces(const double* r) {
  if (states_.empty()) return;
  state_right_.resize(static_cast<Eigen::Index>(states_.size()));
  for (std::size_t k = 0; k < states_.size(); ++k) state_right_[static_cast<Eigen::Index>(k)] = r[2 * n_ + states_[k]];
  for (std::size_t c = 0; c < state_columns_.size(); ++c)
    state_right_ += g_ * r[state_columns_[c]] * state_pose_.col(static_cast<Eigen::Index>(c));
  state_solution_.noalias() = state_answer_ * state_right_;
  state_moved_.noalias() = state_force_ * state_solution_;
  for (std::size_t i = 0; i < state_rows_.size(); ++i) moved_[state_rows_[i]] += state_moved_[static_cast<Eigen::Index>(i)] / g_;
}

void StageSystem::solve_states(const double* r, double* u) {
  if (states_.empty()) return;
  for (std::size_t k = 0; k < states_.size(); ++k) state_right_[static_cast<Eigen::Index>(k)] = r[2 * n_ + states_[k]];
  for (std::size_t c = 0; c < state_columns_.size(); ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    state_right_ += u[state_columns_[c]] * state_pose_.col(at) + u[n_ + state_columns_[c]] * state_velocity_.col(at);
  }
  state_solution_.noalias() = state_answer_ * state_right_;
  for (std::size_t k = 0; k < states_.size(); ++k) u[2 * n_ + states_[k]] = state_solution_[static_cast<Eigen::Index>(k)];
}

void StageSystem::factor_inner() {
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const Linearization::InnerBlock& block = linearization_->inner()[i];
    inner_[i].answer = (Mat3::Identity() / g_ - block.by_inner).inverse();
    inner_[i].damping = block.force * inner_[i].answer * (g_ * block.by_pose + block.by_velocity);
  }
}

// Adds the part of the forces of inner states that depends on r only, not on the solution.
void StageSystem::add_inner_forces(const double* r) {
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const Linearization::InnerBlock& block = linearization_->inner()[i];
    Vec3 z = Vec3::Zero();
    for (int k = 0; k < block.count; ++k) z[k] = r[2 * n_ + block.first + k];
    for (int c = 0; c < 6; ++c)
      if (block.cluster[c / 3] >= 0) z += g_ * block.by_pose.col(c) * r[3 * block.cluster[c / 3] + c % 3];
    const Eigen::Matrix<double, 6, 1> f = block.force * (inner_[i].answer * z);
    for (int c = 0; c < 6; ++c)
      if (block.cluster[c / 3] >= 0) moved_[3 * block.cluster[c / 3] + c % 3] += f[c] / g_;
  }
}

void StageSystem::solve_inner(const double* r, double* u) {
  const int count = linearization_->inner_count();
  for (int k = 0; k < count; ++k) u[2 * n_ + k] = g_ * r[2 * n_ + k];
  for (std::size_t i = 0; i < inner_.size(); ++i) {
    const Linearization::InnerBlock& block = linearization_->inner()[i];
    Vec3 z = Vec3::Zero();
    for (int k = 0; k < block.count; ++k) z[k] = r[2 * n_ + block.first + k];
    for (int c = 0; c < 6; ++c)
      if (const int at = 3 * block.cluster[c / 3] + c % 3; at >= 0)
        z += block.by_pose.col(c) * u[at] + block.by_velocity.col(c) * u[n_ + at];
    z = inner_[i].answer * z;
    for (int k = 0; k < block.count; ++k) u[2 * n_ + block.first + k] = z[k];
  }
}

template <class Put> void StageSystem::assemble(double g, const Put& put) const {
  const std::vector<double>& w = linearization_->inverse_mass();
  for (int i = 0; i < n_; ++i) put(i, i, 1.0);
  for (const auto& e : linearization_->stiffness()) put(e.row(), e.col(), -g * g * position_share(e.col()) * w[e.row()] * e.value());
  for (const auto& e : linearization_->damping()) put(e.row(), e.col(), -g * w[e.row()] * e.value());
  for (std::size_t b = 0; b < inner_.size(); ++b) {
    const int* const cluster = linearization_->inner()[b].cluster;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const int row = 3 * cluster[i / 3] + i % 3, column = 3 * cluster[j / 3] + j % 3;
        if (row >= 0 && column >= 0) put(row, column, -g * w[row] * inner_[b].damping(i, j));
      }
  }
  for (std::size_t i = 0; i < state_rows_.size(); ++i)
    for (std::size_t c = 0; c < state_columns_.size(); ++c)
      put(state_rows_[i], state_columns_[c],
          -g * w[state_rows_[i]] * state_damping_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)));
  const auto put_row = [&](const Linearization::Triplet& e, double value) {
    put(n_ + e.row(), e.col(), is_redundant_[e.row()] ? 0.0 : value);
  };
  const bool is_diagonal = linearization_->response().empty();
  for (const auto& e : linearization_->gradient()) {
    put_row(e, e.value());
    if (is_diagonal) put(e.col(), n_ + e.row(), is_redundant_[e.row()] ? 0.0 : -w[e.col()] * e.value());
  }
  for (const auto& e : linearization_->response()) put(e.row(), n_ + e.col(), is_redundant_[e.col()] ? 0.0 : -e.value());
  for (const auto& e : linearization_->bias_by_pose()) put_row(e, -g * g * position_share(e.col()) * e.value());
  for (const auto& e : linearization_->bias_by_velocity()) put_row(e, -g * e.value());
  for (int r = 0; r < m_; ++r) put(n_ + r, n_ + r, is_redundant_[r] ? 1.0 : 0.0);
}

bool StageSystem::factor(double g) {
  g_ = g;
  factor_inner();
  factor_states();
  if (is_dense_) {
    matrix_.setZero(n_ + m_, n_ + m_);
    assemble(g, [this](int i, int j, double value) { matrix_(i, j) += value; });
    if (!matrix_.allFinite()) return false;
    dense_.factor(matrix_);
    return dense_.least_pivot() > 0.0;
  }
  sparse_.begin(n_ + m_);
  assemble(g, [this](int i, int j, double value) { sparse_.add(i, j, value); });
  return sparse_.factor();
}

void StageSystem::solve(const double* r, double* u) {
  const std::vector<double>& w = linearization_->inverse_mass();
  const double* const r_v = r + n_;
  moved_.setZero();
  for (const auto& e : linearization_->stiffness()) moved_[e.row()] += e.value() * r[e.col()];
  add_inner_forces(r);
  add_state_forces(r);
  for (int i = 0; i < n_; ++i) right_[i] = g_ * (r_v[i] + g_ * w[i] * moved_[i]);
  right_.tail(m_).setZero();
  for (const auto& e : linearization_->gradient()) right_[n_ + e.row()] += g_ * e.value() * r_v[e.col()];
  for (const auto& e : linearization_->bias_by_pose()) right_[n_ + e.row()] += g_ * g_ * e.value() * r[e.col()];
  for (int i = 0; i < m_; ++i)
    if (is_redundant_[i]) right_[n_ + i] = 0.0;
  solve_unknowns();
  for (int i = 0; i < n_; ++i) {
    u[n_ + i] = solution_[i];
    u[i] = g_ * (r[i] + (w[i] > 0.0 ? position_share(i) * solution_[i] : 0.0)); // a locked coordinate follows its prescribed rate
  }
  solve_inner(r, u);
  solve_states(r, u);
}

void StageSystem::solve_unknowns() {
  if (is_dense_) {
    dense_.solve(right_, solution_);
    return;
  }
  solution_ = right_;
  sparse_.solve(solution_.data());
}

void StageSystem::append_force(const ForceRow& row, SparseVectors& out) {
  const std::vector<double>& w = linearization_->inverse_mass();
  double pull[6];
  for (int i = 0; i < row.count; ++i) pull[i] = g_ * w[row.coordinate[i]] * row.gradient[i];
  if (!is_dense_) return sparse_.append_forward(row.coordinate, pull, row.count, out);
  right_.setZero();
  for (int i = 0; i < row.count; ++i) right_[row.coordinate[i]] += pull[i];
  dense_.solve(right_, solution_);
  for (int k = 0; k < n_; ++k) out.add(k, solution_[k]);
  out.end_vector();
}

void StageSystem::append_rate(const ForceRow& row, SparseVectors& out) {
  if (!is_dense_) return sparse_.append_backward(row.coordinate, row.gradient, row.count, out);
  for (int i = 0; i < row.count; ++i) out.add(row.coordinate[i], row.gradient[i]);
  out.end_vector();
}

void StageSystem::finish_forces(const double* sum, double* u) {
  const std::vector<double>& w = linearization_->inverse_mass();
  if (is_dense_) std::copy(sum, sum + n_, solution_.data());
  else sparse_.finish(sum, solution_.data());
  for (int i = 0; i < n_; ++i) {
    u[n_ + i] = w[i] > 0.0 ? solution_[i] : 0.0;
    u[i] = g_ * position_share(i) * u[n_ + i];
  }
}

// Rows that are not held keep their entries, so that the pattern does not change.
bool StageSystem::factor_held(const std::vector<ForceRow>& rows, const std::vector<char>& is_held, const std::vector<double>& softness) {
  const std::vector<double>& w = linearization_->inverse_mass();
  const int first = n_ + m_;
  held_.begin(first + static_cast<int>(rows.size()));
  assemble(g_, [this](int i, int j, double value) { held_.add(i, j, value); });
  for (int r = 0; r < static_cast<int>(rows.size()); ++r) {
    const ForceRow& row = rows[r];
    for (int i = 0; i < row.count; ++i) {
      held_.add(row.coordinate[i], first + r, -g_ * w[row.coordinate[i]] * row.gradient[i]);
      held_.add(first + r, row.coordinate[i], is_held[r] != 0 ? row.gradient[i] : 0.0);
    }
    held_.add(first + r, first + r, softness[r]);
  }
  return held_.factor();
}

void StageSystem::solve_held(std::vector<double>& rates) {
  held_right_.setZero(n_ + m_ + static_cast<Eigen::Index>(rates.size()));
  std::copy(rates.begin(), rates.end(), held_right_.data() + n_ + m_);
  held_.solve(held_right_.data());
  std::copy(held_right_.data() + n_ + m_, held_right_.data() + held_right_.size(), rates.begin());
}

} // namespace steplap
