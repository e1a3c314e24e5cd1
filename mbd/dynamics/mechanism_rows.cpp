// Rows of a mechanism in its own coordinates: what SchurSolver does for clusters.
#include "mbd/dynamics/dependent_rows.h"
#include "mbd/dynamics/mechanism_work.h"

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

struct Pivots {
  int dependent_count = 0;
  double smallest = 1.0;
};

// A = J M⁻¹ Jᵀ row by row: below the diagonal first L D, then L. N: the number of rows if it is small, else 0.
template <int N> Pivots factor_dense(MechanismWork& w, int count, const std::vector<char>& out) {
  constexpr int k_most = MechanismWork::k_most;
  Pivots found;
  double least = 1.0;
  const int m = N > 0 ? N : count;
  const MechanismWork::Shared* pair = w.shared.data();
  double* const a = w.factor.data();
  double* const inverse = w.inverse_pivot.data();
  for (int r = 0; r < m; ++r) {
    const double* const scaled = w.scaled.data() + r * k_most;
    double* const row = a + r * m;
    for (int t = 0; t <= r; ++t, ++pair) {
      const double* const other = w.white.data() + t * k_most;
      double sum = 0.0;
      for (const std::uint8_t *at = w.shared_at.data() + pair->begin, *const end = at + pair->count; at != end; ++at)
        sum += scaled[*at] * other[*at];
      row[t] = sum;
    }
    const double own = w.own[r];
    double d = row[r] + w.shift * own;
    for (int j = 0; j < r; ++j) {
      const double* const before = a + j * m;
      double sum = row[j];
      for (int k = 0; k < j; ++k) sum -= row[k] * before[k];
      row[j] = sum;
    }
    for (int j = 0; j < r; ++j) {
      const double l = row[j] * inverse[j];
      d -= l * row[j];
      row[j] = l;
    }
    const bool is_out = !out.empty() && out[r] != 0;
    if (is_out || !(d > SchurSolver::k_pivot_tolerance * own)) [[unlikely]] {
      inverse[r] = 0.0;
      ++found.dependent_count;
    } else {
      inverse[r] = 1.0 / d;
      if (d < least * own) least = d / own;
    }
  }
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

template <int N> STEPLAP_INLINE void eliminate_dense(const MechanismWork& w, int count, double* x) {
  const double* const l = w.factor.data();
  const int m = N > 0 ? N : count;
  for (int i = 1; i < m; ++i) {
    double sum = x[i];
    for (int j = 0; j < i; ++j) sum -= l[i * m + j] * x[j];
    x[i] = sum;
  }
  for (int i = 0; i < m; ++i) x[i] *= w.inverse_pivot[i];
  for (int i = m - 1; i > 0; --i)
    for (int j = 0; j < i; ++j) x[j] -= l[i * m + j] * x[i];
}

void eliminate(const MechanismWork& w, int m, double* x) {
  switch (m) {
  case 2: return eliminate_dense<2>(w, m, x);
  case 4: return eliminate_dense<4>(w, m, x);
  case 6: return eliminate_dense<6>(w, m, x);
  default: return eliminate_dense<0>(w, m, x);
  }
}

// x += A⁻¹ (right − J M⁻¹ Jᵀ x) while that makes the correction smaller, factor by factor as SchurSolver does it.
void refine(const MechanismWork& w, int m, double* x) {
  std::array<double, MechanismWork::k_most> right, correction, response;
  std::copy(x, x + m, right.begin());
  eliminate(w, m, x);
  double previous = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < k_max_refinements; ++iteration) {
    response.fill(0.0);
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
      correction[r] = sum;
    }
    eliminate(w, m, correction.data());
    double size = 0.0, scale = 0.0;
    for (int r = 0; r < m; ++r) {
      size = std::max(size, std::abs(correction[r]));
      scale = std::max(scale, std::abs(x[r]));
    }
    if (!(size < 0.5 * previous)) return;
    for (int r = 0; r < m; ++r) x[r] += correction[r];
    if (size <= std::numeric_limits<double>::epsilon() * scale) return;
    previous = size;
  }
}

} // namespace

bool Mechanism::is_dependent(int row) const { return work_->inverse_pivot[row] == 0.0; }
const double* Mechanism::gradient(int row) const {
  return work_->gradient.data() + static_cast<std::ptrdiff_t>(row) * k_most;
}

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
  const MechanismWork::Link* const links = work_->links.data();
  for (int side = 0; side < 2; ++side) {
    if (row.body[side] < 0) continue;
    const double* const j = row.j[side];
    const Pair<double> force{j[0], j[1]};
    const MechanismWork::Link* at = links + member_of(row.body[side]);
    gradient[at->coordinate] += j[2] + cross(at->lever, force);
    for (; at->parent >= 0; at = links + at->parent) gradient[links[at->parent].coordinate] += cross(at->arm, force);
    if (!at->is_free) continue;
    gradient[at->coordinate - 2] += force.x;
    gradient[at->coordinate - 1] += force.y;
  }
}

void Mechanism::reduce_rows(const SchurRow* rows) {
  MechanismWork& w = *work_;
  for (int r = 0; r < row_count; ++r) {
    double* const gradient = w.gradient.data() + static_cast<std::ptrdiff_t>(r) * k_most;
    const MechanismWork::RowPattern& pattern = w.patterns[r];
    for (int p = 0; p < pattern.count; ++p) gradient[pattern.at[p]] = 0.0;
    reduce(rows[r], gradient);
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
  for (int i = 0; i < n_; ++i) pull[i] = 0.0;
  for (int r = 0; r < row_count; ++r) {
    const double* const j = gradient(r);
    const MechanismWork::RowPattern& pattern = work_->patterns[r];
    for (int p = 0; p < pattern.count; ++p) pull[pattern.at[p]] += j[pattern.at[p]] * lambda[r];
  }
  solve_mass(pull.data());
  for (int i = 0; i < n_; ++i) change[i] += pull[i];
}

void Mechanism::factor_rows(const SchurRow* rows, double shift) {
  MechanismWork& w = *work_;
  for (int r = 0; r < row_count; ++r) {
    const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(r) * k_most;
    const double* const gradient = w.gradient.data() + first;
    double* const white = w.white.data() + first;
    double* const scaled = w.scaled.data() + first;
    const MechanismWork::RowPattern& pattern = w.patterns[r];
    for (int p = 0; p < pattern.count; ++p) white[pattern.at[p]] = gradient[pattern.at[p]];
    w.whiten(white, pattern.at.data(), pattern.count);
    for (int p = 0; p < pattern.count; ++p) scaled[pattern.at[p]] = white[pattern.at[p]] * w.inverse_d[pattern.at[p]];
    w.own[r] = own_compliance(rows[r]);
  }
  factor_as_is(shift);
  if (is_rank_open_) [[unlikely]] keep_rank(shift);
}

void Mechanism::factor_as_is(double shift) {
  work_->shift = shift;
  const Pivots found = factor(*work_, row_count, out_);
  dependent_count_ = found.dependent_count;
  smallest_pivot_ = found.smallest;
}

void Mechanism::decide_rank(const char* is_friction) {
  can_stay_out_.assign(is_friction, is_friction + row_count);
  if (!out_.empty()) was_out_.swap(out_);
  out_.clear();
  is_rank_open_ = row_count > 0;
}

void Mechanism::keep_rank(double shift) {
  const MechanismWork& w = *work_;
  is_rank_open_ = false;
  if (dependent_count_ == 0 && smallest_pivot_ >= k_doubtful_pivot) return was_out_.clear();
  bool is_in_doubt = smallest_pivot_ < k_doubtful_pivot;
  for (int r = 0; r < row_count; ++r) is_in_doubt = is_in_doubt || (is_dependent(r) && w.own[r] > 0.0);
  if (!is_in_doubt) { // what is out acts on nothing that can move
    out_.assign(row_count, 0);
    for (int r = 0; r < row_count; ++r) out_[r] = can_stay_out_[r] != 0 && is_dependent(r);
    return;
  }
  std::vector<WeightedRow> in_masses(row_count); // beyond the pins
  for (int r = 0; r < row_count; ++r) {
    in_masses[r].row = VecX::Zero(n_);
    for (int p = 0; p < w.patterns[r].count; ++p) {
      const int i = w.patterns[r].at[p];
      in_masses[r].row[i] = w.white[static_cast<std::size_t>(r) * k_most + i] * std::sqrt(w.inverse_d[i]);
    }
    in_masses[r].length = std::sqrt(w.own[r]);
  }
  out_ = dependent_rows(in_masses, can_stay_out_.data(), was_out_);
  factor_as_is(shift);
}

void Mechanism::solve_rows(double* x) const {
  if (smallest_pivot_ >= SchurSolver::k_refined_pivot || work_->shift > 0.0) [[likely]]
    return eliminate(*work_, row_count, x);
  refine(*work_, row_count, x);
}

} // namespace steplap
