#include "mbd/rest/bordered_system.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_delta = 1e-10; // relative to the squared length of rows
constexpr double k_rho = 1.0;     // relative to the largest entries of A
constexpr int k_most_refinements = 8;
constexpr double k_refined = 1e-13, k_solved = 1e-6;

} // namespace

VecX pull_of(const std::vector<SparseRow>& rows, const VecX& y, Eigen::Index n) {
  VecX pull = VecX::Zero(n);
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int k = 0; k < rows[r].count; ++k) pull[rows[r].at[k]] += rows[r].j[k] * y[static_cast<Eigen::Index>(r)];
  return pull;
}

// Determines the order of bodies by approximate least degree in the graph of bodies that act on each other.
void BorderedSystem::find_order(const Sparse& a, const std::vector<SparseRow>& rows) {
  const long bodies = n_ / 3;
  std::vector<long> pairs;
  for (int c = 0; c < a.outerSize(); ++c)
    for (Sparse::InnerIterator it(a, c); it; ++it)
      if (it.row() / 3 < c / 3) pairs.push_back(static_cast<long>(it.row() / 3) * bodies + c / 3);
  for (const SparseRow& row : rows)
    for (int k = 3; k < row.count; k += 3)
      for (int l = 0; l < k; l += 3) {
        const auto [low, high] = std::minmax({row.at[k] / 3, row.at[l] / 3});
        pairs.push_back(static_cast<long>(low) * bodies + high);
      }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<Eigen::Triplet<double, int>> graph;
  for (const long pair : pairs) {
    const int i = static_cast<int>(pair / bodies), j = static_cast<int>(pair % bodies);
    graph.emplace_back(i, j, 1.0);
    graph.emplace_back(j, i, 1.0);
  }
  for (int i = 0; i < static_cast<int>(bodies); ++i) graph.emplace_back(i, i, 1.0);
  Sparse adjacent(static_cast<int>(bodies), static_cast<int>(bodies));
  adjacent.setFromTriplets(graph.begin(), graph.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
  Eigen::AMDOrdering<int>()(adjacent, order);
  std::vector<std::vector<int>> of_body(static_cast<std::size_t>(bodies));
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (int k = 0; k < rows[r].count; k += 3) of_body[rows[r].at[k] / 3].push_back(static_cast<int>(r));
  place_.assign(static_cast<std::size_t>(n_ + m_), -1);
  int next = 0;
  for (Eigen::Index i = 0; i < bodies; ++i) {
    const int body = order.indices()[i];
    for (int c = 0; c < 3; ++c) place_[3 * body + c] = next++;
    for (const int r : of_body[body])
      if (int& place = place_[n_ + r]; place < 0) place = next++;
  }
  for (int& place : place_)
    if (place < 0) place = next++; // a row between the ground and itself
}

// Calls f(i, j, value) for each entry of the upper triangle. The order of calls depends on the pattern alone.
template <class F> void BorderedSystem::for_entries(const Sparse& a, const std::vector<SparseRow>& rows, const F& f) const {
  const auto put = [&](int i, int j, double value) {
    const int p = place_[i], q = place_[j];
    if (p <= q) f(p, q, value);
  };
  for (int c = 0; c < a.outerSize(); ++c)
    for (Sparse::InnerIterator it(a, c); it; ++it) put(static_cast<int>(it.row()), c, it.value());
  for (int i = 0; i < static_cast<int>(n_ + m_); ++i) put(i, i, 0.0);
  for (int r = 0; r < static_cast<int>(m_); ++r) {
    const SparseRow& row = rows[static_cast<std::size_t>(r)];
    for (int k = 0; k < row.count; ++k) {
      const int p = place_[row.at[k]], q = place_[n_ + r];
      f(std::min(p, q), std::max(p, q), row.j[k]);
      for (int l = 0; l < row.count; ++l) put(row.at[k], row.at[l], k_rho * row.j[k] * row.j[l]);
    }
  }
}

void BorderedSystem::find_slots(const Sparse& a, const std::vector<SparseRow>& rows) {
  std::vector<Eigen::Triplet<double, int>> entries;
  for_entries(a, rows, [&](int p, int q, double value) { entries.emplace_back(p, q, value); });
  whole_.resize(static_cast<int>(n_ + m_), static_cast<int>(n_ + m_));
  whole_.setFromTriplets(entries.begin(), entries.end());
  factors_.analyzePattern(whole_);
  const int* const outer = whole_.outerIndexPtr();
  const int* const inner = whole_.innerIndexPtr();
  entry_slot_.clear();
  for (const auto& entry : entries) {
    const int* const column = inner + outer[entry.col()];
    entry_slot_.push_back(static_cast<int>(std::lower_bound(column, inner + outer[entry.col() + 1], entry.row()) - inner));
  }
  // In an upper triangle stored by columns, the diagonal entry is the last one of each column.
  slot_.resize(static_cast<std::size_t>(n_ + m_));
  for (std::size_t i = 0; i < slot_.size(); ++i) slot_[i] = outer[place_[i] + 1] - 1;
  diagonal_.resize(slot_.size());
}

void BorderedSystem::set(const Sparse& a, const std::vector<SparseRow>& rows, const VecX& diagonal) {
  n_ = a.rows();
  m_ = static_cast<Eigen::Index>(rows.size());
  shift_by_ = diagonal;
  std::vector<int> pattern(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize() + 1);
  pattern.insert(pattern.end(), a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros());
  for (const SparseRow& row : rows) {
    pattern.push_back(row.count);
    pattern.insert(pattern.end(), row.at.begin(), row.at.begin() + row.count);
  }
  if (pattern != pattern_) {
    pattern_ = std::move(pattern);
    find_order(a, rows);
    find_slots(a, rows);
  }
  std::fill_n(whole_.valuePtr(), whole_.nonZeros(), 0.0);
  std::size_t next = 0;
  for_entries(a, rows, [&](int, int, double value) { whole_.valuePtr()[entry_slot_[next++]] += value; });
  for (std::size_t i = 0; i < slot_.size(); ++i) diagonal_[i] = whole_.valuePtr()[slot_[i]];
}

bool BorderedSystem::factor(double sigma) {
  const double shift = n_ > 0 ? std::abs(sigma) * shift_by_.maxCoeff() : 0.0;
  delta_ = k_delta / (1.0 + shift);
  for (Eigen::Index i = 0; i < n_; ++i) whole_.valuePtr()[slot_[i]] = diagonal_[i] + sigma * shift_by_[i];
  for (Eigen::Index i = n_; i < n_ + m_; ++i) whole_.valuePtr()[slot_[i]] = diagonal_[i] - delta_;
  factors_.factorize(whole_);
  if (factors_.info() != Eigen::Success || !factors_.vectorD().allFinite()) return false;
  negative_ = static_cast<int>((factors_.vectorD().array() < 0.0).count() - m_);
  return true;
}

bool BorderedSystem::solve(const VecX& f, VecX& x, VecX* y, const VecX* off) const {
  VecX right = VecX::Zero(n_ + m_);
  for (Eigen::Index i = 0; i < n_; ++i) right[place_[i]] = f[i];
  for (Eigen::Index r = 0; off && r < m_; ++r) right[place_[n_ + r]] = (*off)[r];
  // The equations also contain ρ Jᵀ(J x − r), which vanishes if J x = r.
  if (off) {
    VecX pull = VecX::Zero(n_ + m_);
    for (Eigen::Index r = 0; r < m_; ++r) pull[place_[n_ + r]] = k_rho * (*off)[r];
    VecX part = whole_.selfadjointView<Eigen::Upper>() * pull;
    for (Eigen::Index i = 0; i < n_; ++i) right[place_[i]] += part[place_[i]];
  }
  VecX z = factors_.solve(right), residual;
  double before = 0.0;
  const double size = right.cwiseAbs().maxCoeff();
  for (int i = 0;; ++i) {
    if (!z.allFinite()) return false;
    residual = right - whole_.selfadjointView<Eigen::Upper>() * z;
    for (Eigen::Index r = n_; r < n_ + m_; ++r) residual[place_[r]] -= delta_ * z[place_[r]];
    const double now = residual.cwiseAbs().maxCoeff();
    if (now <= k_refined * size || i == k_most_refinements || (i > 0 && now > 0.5 * before)) {
      if (!off && !(now <= k_solved * size)) return false; // for given r, rounding can make dependent rows contradict each other slightly
      break;
    }
    before = now;
    z += factors_.solve(residual);
  }
  x.resize(n_);
  for (Eigen::Index i = 0; i < n_; ++i) x[i] = z[place_[i]];
  if (y) {
    y->resize(m_);
    for (Eigen::Index r = 0; r < m_; ++r) (*y)[r] = z[place_[n_ + r]];
  }
  return true;
}

} // namespace steplap
