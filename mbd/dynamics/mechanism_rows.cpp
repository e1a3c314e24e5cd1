// Rows of a mechanism in its own coordinates: what SchurSolver does for clusters.
#include "mbd/dynamics/dependent_rows.h"
#include "mbd/dynamics/mechanism.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_max_refinements = 4;
constexpr double k_doubtful_pivot = 1e-8; // as in schur.cpp

double own_compliance(const SchurRow& row) {
  double sum = 0.0;
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0)
      for (int c = 0; c < 3; ++c) sum += row.wj[side][c] * row.j[side][c];
  return sum;
}

} // namespace

void Mechanism::reduce(const SchurRow& row, double* gradient) const {
  for (int i = 0; i < n_; ++i) gradient[i] = 0.0;
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const double* const j = row.j[side];
    const Pair<double> force{j[0], j[1]};
    int at = member_of(row.body[side]);
    gradient[members[at].coordinate] += j[2] + cross(moving_[at].lever, force);
    for (; members[at].parent >= 0; at = members[at].parent)
      gradient[members[members[at].parent].coordinate] += cross(moving_[at].arm, force);
    if (!members[at].is_free) continue;
    gradient[members[at].coordinate - 2] += force.x;
    gradient[members[at].coordinate - 1] += force.y;
  }
}

void Mechanism::reduce_rows(const SchurRow* rows) {
  for (int r = 0; r < row_count; ++r) reduce(rows[r], gradient_.data() + static_cast<std::ptrdiff_t>(r) * n_);
}

double Mechanism::along(int row, const double* change) const {
  const double* const j = gradient(row);
  double sum = 0.0;
  for (int i = 0; i < n_; ++i) sum += j[i] * change[i];
  return sum;
}

void Mechanism::add_response(const double* lambda, double* change) const {
  std::array<double, k_most> pull{};
  for (int r = 0; r < row_count; ++r) {
    const double* const j = gradient(r);
    for (int i = 0; i < n_; ++i) pull[i] += j[i] * lambda[r];
  }
  solve_mass(pull.data());
  for (int i = 0; i < n_; ++i) change[i] += pull[i];
}

void Mechanism::factor_rows(const SchurRow* rows, double shift) {
  std::copy(gradient_.begin(), gradient_.end(), white_.begin());
  for (int r = 0; r < row_count; ++r) {
    whiten(white_.data() + static_cast<std::ptrdiff_t>(r) * n_);
    own_[r] = own_compliance(rows[r]);
  }
  factor_as_is(rows, shift);
  if (is_rank_open_) [[unlikely]] keep_rank(rows, shift);
}

void Mechanism::factor_as_is(const SchurRow*, double shift) {
  shift_ = shift;
  dependent_count_ = 0;
  smallest_pivot_ = 1.0;
  const int m = row_count;
  std::array<double, k_most> scaled; // a row's white_ over D
  for (int r = 0; r < m; ++r) {
    const double* const white = white_.data() + static_cast<std::ptrdiff_t>(r) * n_;
    double* const row = factor_.data() + static_cast<std::ptrdiff_t>(r) * m;
    for (int i = 0; i < n_; ++i) scaled[i] = white[i] * inverse_mass_[i];
    for (int t = 0; t <= r; ++t) {
      const double* const other = white_.data() + static_cast<std::ptrdiff_t>(t) * n_;
      double sum = 0.0;
      for (int i = 0; i < n_; ++i) sum += scaled[i] * other[i];
      row[t] = sum;
    }
    double d = row[r] + shift * own_[r];
    for (int j = 0; j < r; ++j) {
      const double* const before = factor_.data() + static_cast<std::ptrdiff_t>(j) * m;
      double sum = row[j];
      for (int k = 0; k < j; ++k) sum -= row[k] * before[k];
      row[j] = sum;
    }
    for (int j = 0; j < r; ++j) {
      const double l = row[j] * inverse_d_[j];
      d -= l * row[j];
      row[j] = l;
    }
    if (is_left_out(r) || !(d > SchurSolver::k_pivot_tolerance * own_[r])) [[unlikely]] {
      inverse_d_[r] = 0.0;
      ++dependent_count_;
    } else {
      inverse_d_[r] = 1.0 / d;
      smallest_pivot_ = std::min(smallest_pivot_, d / own_[r]);
    }
  }
}

void Mechanism::decide_rank(const char* is_friction) {
  can_stay_out_.assign(is_friction, is_friction + row_count);
  if (!out_.empty()) was_out_.swap(out_);
  out_.clear();
  is_rank_open_ = row_count > 0;
}

void Mechanism::keep_rank(const SchurRow* rows, double shift) {
  is_rank_open_ = false;
  if (dependent_count_ == 0 && smallest_pivot_ >= k_doubtful_pivot) return was_out_.clear();
  bool is_in_doubt = smallest_pivot_ < k_doubtful_pivot;
  for (int r = 0; r < row_count; ++r) is_in_doubt = is_in_doubt || (is_dependent(r) && own_[r] > 0.0);
  if (!is_in_doubt) { // what is out acts on nothing that can move
    out_.assign(row_count, 0);
    for (int r = 0; r < row_count; ++r) out_[r] = can_stay_out_[r] != 0 && is_dependent(r);
    return;
  }
  std::vector<WeightedRow> in_masses(row_count); // beyond the pins
  for (int r = 0; r < row_count; ++r) {
    in_masses[r].row.resize(n_);
    for (int i = 0; i < n_; ++i)
      in_masses[r].row[i] = white_[static_cast<std::size_t>(r) * n_ + i] * std::sqrt(inverse_mass_[i]);
    in_masses[r].length = std::sqrt(own_[r]);
  }
  out_ = dependent_rows(in_masses, can_stay_out_.data(), was_out_);
  factor_as_is(rows, shift);
}

void Mechanism::eliminate(double* x) const {
  const int m = row_count;
  const double* const l = factor_.data();
  for (int i = 1; i < m; ++i)
    for (int j = 0; j < i; ++j) x[i] -= l[i * m + j] * x[j];
  for (int i = 0; i < m; ++i) x[i] *= inverse_d_[i];
  for (int i = m - 1; i > 0; --i)
    for (int j = 0; j < i; ++j) x[j] -= l[i * m + j] * x[i];
}

void Mechanism::solve_rows(double* x) const {
  if (smallest_pivot_ >= SchurSolver::k_refined_pivot || shift_ > 0.0) [[likely]]
    return eliminate(x);
  refine(x);
}

// x += A⁻¹ (right − J M⁻¹ Jᵀ x) while that makes the correction smaller, factor by factor as SchurSolver does it.
void Mechanism::refine(double* x) const {
  std::array<double, k_most> right, correction, response;
  std::copy(x, x + row_count, right.begin());
  eliminate(x);
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_max_refinements; ++iteration) {
    response.fill(0.0);
    for (int r = 0; r < row_count; ++r)
      for (int i = 0; i < n_; ++i) response[i] += white_[static_cast<std::size_t>(r) * n_ + i] * x[r];
    for (int i = 0; i < n_; ++i) response[i] *= inverse_mass_[i];
    for (int r = 0; r < row_count; ++r) {
      double sum = right[r];
      for (int i = 0; i < n_; ++i) sum -= white_[static_cast<std::size_t>(r) * n_ + i] * response[i];
      correction[r] = sum;
    }
    eliminate(correction.data());
    double size = 0.0, scale = 0.0;
    for (int r = 0; r < row_count; ++r) {
      size = std::max(size, std::abs(correction[r]));
      scale = std::max(scale, std::abs(x[r]));
    }
    if (!(size < 0.5 * previous)) return;
    for (int r = 0; r < row_count; ++r) x[r] += correction[r];
    if (size <= std::numeric_limits<double>::epsilon() * scale) return;
    previous = size;
  }
}

} // namespace steplap
