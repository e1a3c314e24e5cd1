// Rows of a mechanism in joint coordinates, by the same methods as in SchurSolver.
#include "mbd/dynamics/dependent_rows.h"
#include "mbd/dynamics/mechanism_work.h"
#include "mbd/dynamics/refinement.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_doubtful_pivot = 1e-8; // as in schur.cpp

struct Pivots {
  int dependent_count = 0;
  double smallest = 1.0;
};

template <int N> Pivots factor_dense(MechanismWork& w, int count, const std::vector<char>& out) {
  Pivots found;
  double least = 1.0;
  const auto raise = [&w](double d, double own) { return d + w.shift * own; };
  w.factor_rows<N>(count, raise, [&](int r, double d, double own) {
    const bool is_out = !out.empty() && out[r] != 0;
    if (is_out || !(d > SchurSolver::k_pivot_tolerance * own)) [[unlikely]] {
      ++found.dependent_count;
      return 0.0;
    }
    if (d < least * own) least = d / own;
    return 1.0 / d;
  });
  found.smallest = least;
  return found;
}

Pivots factor(MechanismWork& w, int count, const std::vector<char>& out) {
  switch (count) {
  case 1: return factor_dense<1>(w, count, out);
  case 2: return factor_dense<2>(w, count, out);
  case 3: return factor_dense<3>(w, count, out);
  case 4: return factor_dense<4>(w, count, out);
  case 6: return factor_dense<6>(w, count, out);
  default: return factor_dense<0>(w, count, out);
  }
}

void eliminate(const MechanismWork& w, int m, double* x) {
  switch (m) {
  case 2: return w.eliminate<2>(m, x);
  case 4: return w.eliminate<4>(m, x);
  case 6: return w.eliminate<6>(m, x);
  default: return w.eliminate<0>(m, x);
  }
}

// Computes the residual `right` − J M⁻¹ Jᵀ x.
void find_lack(const MechanismWork& w, int m, const double* right, const double* x, double* lack) {
  std::array<double, MechanismWork::k_most> response{};
  for (int r = 0; r < m; ++r)
    for (int p = 0; p < w.patterns[r].count; ++p) {
      const int i = w.patterns[r].at[p];
      response[i] += w.scaled[static_cast<std::size_t>(r) * MechanismWork::k_most + i] * x[r];
    }
  for (int r = 0; r < m; ++r) {
    double sum = right[r];
    for (int p = 0; p < w.patterns[r].count; ++p) {
      const int i = w.patterns[r].at[p];
      sum -= w.white[static_cast<std::size_t>(r) * MechanismWork::k_most + i] * response[i];
    }
    lack[r] = sum;
  }
}

void refine(const MechanismWork& w, int m, double* x) {
  std::array<double, MechanismWork::k_most> right, correction;
  std::copy(x, x + m, right.begin());
  eliminate(w, m, x);
  refine_solution(m, x, [&](const double* now) {
    find_lack(w, m, right.data(), now, correction.data());
    eliminate(w, m, correction.data());
    return correction.data();
  });
}

} // namespace

bool Mechanism::is_dependent(int row) const { return work_->inverse_pivot[row] == 0.0; }
const double* Mechanism::gradient(int row) const { return work_->gradient.data() + static_cast<std::ptrdiff_t>(row) * k_most; }

void Mechanism::find_patterns(const SchurRow* rows) {
  MechanismWork& w = *work_;
  const auto count = static_cast<std::size_t>(row_count);
  std::vector<unsigned> moved(count, 0U);
  w.patterns.assign(count, {});
  for (std::size_t r = 0; r < count; ++r) {
    for (const int cluster : rows[r].body)
      if (cluster >= 0) moved[r] |= path_[member_of(cluster)];
    for (int i = n_ - 1; i >= 0; --i)
      if ((moved[r] >> i & 1U) != 0) w.patterns[r].at[w.patterns[r].count++] = static_cast<std::uint8_t>(i);
    for (std::size_t t = 0; t <= r; ++t) {
      MechanismWork::Shared pair;
      pair.begin = static_cast<std::uint16_t>(w.shared_at.size());
      for (int i = 0; i < n_; ++i)
        if ((moved[r] & moved[t]) >> i & 1U) w.shared_at.push_back(static_cast<std::uint8_t>(i));
      pair.count = static_cast<std::uint16_t>(w.shared_at.size() - pair.begin);
      w.shared.push_back(pair);
    }
  }
  for (auto* numbers : {&w.gradient, &w.white, &w.scaled}) numbers->assign(count * k_most, 0.0);
  w.factor.assign(count * count, 0.0);
  w.inverse_pivot.assign(count, 0.0);
  w.own.assign(count, 0.0);
}

void Mechanism::reduce(const SchurRow& row, double* gradient) const {
  int member[2] = {-1, -1};
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0) member[side] = member_of(row.body[side]);
  work_->reduce(row, member, gradient);
}

void Mechanism::reduce_rows(const SchurRow* rows) {
  MechanismWork& w = *work_;
  for (int r = 0; r < row_count; ++r) {
    w.clear_gradient(static_cast<std::size_t>(r));
    reduce(rows[r], w.gradient.data() + static_cast<std::ptrdiff_t>(r) * k_most);
  }
}

double Mechanism::along(int row, const double* change) const {
  const double* const j = gradient(row);
  const MechanismWork::RowPattern& pattern = work_->patterns[row];
  double sum = 0.0;
  for (int p = 0; p < pattern.count; ++p) sum += j[pattern.at[p]] * change[pattern.at[p]];
  return sum;
}

void Mechanism::add_response(const double* lambda, double* change) const {
  std::array<double, k_most> pull;
  work_->pull_rows(row_count, lambda, pull.data());
  solve_mass(pull.data());
  for (int i = 0; i < n_; ++i) change[i] += pull[i];
}

void Mechanism::factor_rows(const SchurRow* rows, double shift) {
  for (int r = 0; r < row_count; ++r) work_->whiten_row(static_cast<std::size_t>(r), rows[r]);
  factor_as_is(shift);
  if (is_rank_open_) [[unlikely]]
    keep_rank(shift);
}

void Mechanism::factor_as_is(double shift) {
  work_->shift = shift;
  const Pivots found = factor(*work_, row_count, out_);
  dependent_count_ = found.dependent_count;
  smallest_pivot_ = found.smallest;
}

void Mechanism::decide_rank(const char* is_friction, const char* was_out) {
  can_stay_out_.assign(is_friction, is_friction + row_count);
  was_dependent_.assign(was_out, was_out + row_count);
  out_.clear();
  is_rank_open_ = row_count > 0;
}

void Mechanism::keep_rank(double shift) {
  const MechanismWork& w = *work_;
  is_rank_open_ = false;
  if (dependent_count_ == 0 && smallest_pivot_ >= k_doubtful_pivot) return;
  bool is_rank_uncertain = smallest_pivot_ < k_doubtful_pivot;
  for (int r = 0; r < row_count; ++r) is_rank_uncertain = is_rank_uncertain || (is_dependent(r) && w.own[r] > 0.0);
  if (!is_rank_uncertain) { // the rows left out act on nothing that can move
    out_.assign(row_count, 0);
    for (int r = 0; r < row_count; ++r) out_[r] = can_stay_out_[r] != 0 && is_dependent(r);
    return;
  }
  std::vector<WeightedRow> in_masses(row_count); // part of each row that is orthogonal to the pins
  for (int r = 0; r < row_count; ++r) {
    in_masses[r].row = VecX::Zero(n_);
    for (int p = 0; p < w.patterns[r].count; ++p) {
      const int i = w.patterns[r].at[p];
      in_masses[r].row[i] = w.white[static_cast<std::size_t>(r) * k_most + i] * std::sqrt(w.inverse_d[i]);
    }
    in_masses[r].length = std::sqrt(w.own[r]);
  }
  out_ = dependent_rows(in_masses, can_stay_out_.data(), was_dependent_);
  factor_as_is(shift);
}

void Mechanism::solve_rows(double* x) const {
  if (smallest_pivot_ >= SchurSolver::k_refined_pivot || work_->shift > 0.0) [[likely]]
    return eliminate(*work_, row_count, x);
  refine(*work_, row_count, x);
}

} // namespace steplap
