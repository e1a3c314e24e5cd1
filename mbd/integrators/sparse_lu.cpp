#include "mbd/integrators/sparse_lu.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace steplap {

void SparseLu::begin(int n) {
  if (n != n_) is_known_ = false;
  n_ = n;
  count_ = 0;
  if (is_known_) std::fill(values_.begin(), values_.end(), 0.0);
  else added_.clear();
}

// The pattern differs from entry k on. The values of the entries before k are recovered from the sums in values_, and later entries are
// appended.
void SparseLu::add_unknown(std::size_t k, int row, int column, double value) {
  if (is_known_) {
    added_.assign(k, 0.0);
    for (std::size_t i = k; i-- > 0;) std::swap(added_[i], values_[places_[i]]);
    is_known_ = false;
  }
  rows_.resize(k);
  columns_.resize(k);
  rows_.push_back(row);
  columns_.push_back(column);
  added_.push_back(value);
}

// Sorts the entries by column, merges those at the same matrix position, and determines the order of elimination.
void SparseLu::analyze() {
  const std::size_t count = rows_.size();
  std::vector<int> sorted(count);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::sort(sorted.begin(), sorted.end(),
            [this](int a, int b) { return columns_[a] != columns_[b] ? columns_[a] < columns_[b] : rows_[a] < rows_[b]; });
  begin_.assign(n_ + 1, 0);
  index_.clear();
  places_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int e = sorted[i];
    const bool is_new = i == 0 || columns_[e] != columns_[sorted[i - 1]] || rows_[e] != rows_[sorted[i - 1]];
    if (is_new) {
      index_.push_back(rows_[e]);
      ++begin_[columns_[e] + 1];
    }
    places_[e] = static_cast<int>(index_.size()) - 1;
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  values_.assign(index_.size(), 0.0);
  for (std::size_t e = 0; e < count; ++e) values_[places_[e]] += added_[e];

  Eigen::SparseMatrix<double> pattern(n_, n_);
  std::vector<Eigen::Triplet<double>> entries;
  for (int c = 0; c < n_; ++c)
    for (int k = begin_[c]; k < begin_[c + 1]; ++k) entries.emplace_back(index_[k], c, 1.0);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(n_);
  Eigen::COLAMDOrdering<int> ordering;
  ordering(pattern, permutation);
  order_.resize(n_);
  for (int c = 0; c < n_; ++c) order_[permutation.indices()[c]] = c;

  for (auto* v : {&position_, &pivot_, &stack_, &resume_, &found_}) v->assign(n_, 0);
  mark_.assign(n_, -1);
  stamp_ = 0;
  queue_.reserve(n_);
  work_.assign(n_, 0.0);
  inverse_pivot_.assign(n_, 0.0);
  is_known_ = true;
  has_pivots_ = false;
}

bool SparseLu::factor() {
  if (is_known_ && count_ != rows_.size()) { // the entries are only the first ones of the analysed pattern
    added_.assign(count_, 0.0);
    for (std::size_t i = count_; i-- > 0;) std::swap(added_[i], values_[places_[i]]);
    rows_.resize(count_);
    columns_.resize(count_);
    is_known_ = false;
  }
  if (!is_known_) analyze();
  for (const double value : values_)
    if (!std::isfinite(value)) return false;
  return (has_pivots_ && refactor()) || factor_with_pivoting();
}

// Depth-first search: puts the rows of L reached from `row` into found_, in topological order, from index `top` downwards.
void SparseLu::visit(int row, int& top) {
  int depth = 0;
  stack_[0] = row;
  mark_[row] = stamp_;
  resume_[0] = position_[row] < 0 ? 0 : l_begin_[position_[row]];
  while (depth >= 0) {
    const int at = stack_[depth], k = position_[at];
    const int end = k < 0 ? 0 : l_begin_[k + 1];
    int next = -1;
    while (k >= 0 && resume_[depth] < end && next < 0) {
      const int candidate = l_row_[resume_[depth]++];
      if (mark_[candidate] != stamp_) next = candidate;
    }
    if (next < 0) {
      found_[--top] = at;
      --depth;
      continue;
    }
    mark_[next] = stamp_;
    stack_[++depth] = next;
    resume_[depth] = position_[next] < 0 ? 0 : l_begin_[position_[next]];
  }
}

int SparseLu::reach(int column) {
  int top = n_;
  ++stamp_;
  for (int k = begin_[column]; k < begin_[column + 1]; ++k)
    if (mark_[index_[k]] != stamp_) visit(index_[k], top);
  return top;
}

bool SparseLu::factor_with_pivoting() {
  has_pivots_ = has_transposed_ = false;
  std::fill(position_.begin(), position_.end(), -1);
  std::fill(work_.begin(), work_.end(), 0.0);
  for (auto* v : {&l_row_, &u_position_}) v->clear();
  l_.clear();
  u_.clear();
  l_begin_.assign(1, 0);
  u_begin_.assign(1, 0);
  for (int k = 0; k < n_; ++k) {
    const int column = order_[k], top = reach(column);
    for (int p = begin_[column]; p < begin_[column + 1]; ++p) work_[index_[p]] = values_[p];
    for (int p = top; p < n_; ++p) {
      const int row = found_[p], position = position_[row];
      if (position < 0) continue;
      const double u = work_[row];
      u_position_.push_back(position);
      u_.push_back(u);
      for (int e = l_begin_[position]; e < l_begin_[position + 1]; ++e) work_[l_row_[e]] -= l_[e] * u;
      work_[row] = 0.0;
    }
    int best = -1;
    for (int p = top; p < n_; ++p) {
      const int row = found_[p];
      if (position_[row] < 0 && (best < 0 || std::abs(work_[row]) > std::abs(work_[best]))) best = row;
    }
    u_begin_.push_back(static_cast<int>(u_.size()));
    if (best < 0 || !(std::abs(work_[best]) > 0.0)) return false;
    pivot_[k] = best;
    position_[best] = k;
    inverse_pivot_[k] = 1.0 / work_[best];
    for (int p = top; p < n_; ++p) {
      const int row = found_[p];
      if (position_[row] < 0) {
        l_row_.push_back(row);
        l_.push_back(work_[row] * inverse_pivot_[k]);
      }
      work_[row] = 0.0;
    }
    l_begin_.push_back(static_cast<int>(l_.size()));
  }
  // Capacity is reserved in advance, because other pivots give other fill-in.
  const auto make_room = [](auto& list) {
    if (list.capacity() < list.size() + list.size() / 4) list.reserve(2 * list.size());
  };
  make_room(l_row_);
  make_room(u_position_);
  make_room(l_);
  make_room(u_);
  has_pivots_ = true;
  return true;
}

bool SparseLu::refactor() {
  for (int k = 0; k < n_; ++k) {
    const int column = order_[k];
    for (int p = begin_[column]; p < begin_[column + 1]; ++p) work_[index_[p]] = values_[p];
    for (int e = u_begin_[k]; e < u_begin_[k + 1]; ++e) {
      const int position = u_position_[e], row = pivot_[position];
      const double u = work_[row];
      u_[e] = u;
      work_[row] = 0.0;
      for (int i = l_begin_[position]; i < l_begin_[position + 1]; ++i) work_[l_row_[i]] -= l_[i] * u;
    }
    const double pivot = work_[pivot_[k]];
    double largest = 0.0;
    for (int e = l_begin_[k]; e < l_begin_[k + 1]; ++e) largest = std::max(largest, std::abs(work_[l_row_[e]]));
    if (!(std::abs(pivot) > k_pivot_share * largest)) return false; // the comparison is also true for 0/0
    inverse_pivot_[k] = 1.0 / pivot;
    work_[pivot_[k]] = 0.0;
    for (int e = l_begin_[k]; e < l_begin_[k + 1]; ++e) {
      l_[e] = work_[l_row_[e]] * inverse_pivot_[k];
      work_[l_row_[e]] = 0.0;
    }
  }
  return true;
}

void SparseLu::solve(double* x) {
  for (int k = 0; k < n_; ++k) {
    const double value = x[pivot_[k]];
    work_[k] = value;
    for (int e = l_begin_[k]; e < l_begin_[k + 1]; ++e) x[l_row_[e]] -= l_[e] * value;
  }
  finish_work(x);
}

void SparseLu::finish(const double* y, double* x) {
  std::copy(y, y + n_, work_.begin());
  finish_work(x);
}

// Computes x = B work_ (second half of the solution) and sets work_ to zero.
void SparseLu::finish_work(double* x) {
  for (int k = n_ - 1; k >= 0; --k) {
    const double value = work_[k] * inverse_pivot_[k];
    for (int e = u_begin_[k]; e < u_begin_[k + 1]; ++e) work_[u_position_[e]] -= u_[e] * value;
    x[order_[k]] = value;
    work_[k] = 0.0;
  }
}

void SparseLu::start_at(int position, double value) {
  work_[position] += value;
  if (mark_[position] == stamp_) return;
  mark_[position] = stamp_;
  queue_.push_back(position);
}

// Eliminates the nonzero entries of work_ in ascending order of steps, and appends the results to `out`. A step depends only on earlier
// ones, so the least step in the queue is final.
template <class Column> void SparseLu::append_reached(const Column& column, SparseVectors& out) {
  std::make_heap(queue_.begin(), queue_.end(), std::greater<>());
  while (!queue_.empty()) {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    const int k = queue_.back();
    queue_.pop_back();
    const double value = work_[k];
    work_[k] = 0.0;
    out.add(k, column(k, value, [this](int position, double change) {
              const std::size_t size = queue_.size();
              start_at(position, change);
              if (queue_.size() > size) std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
            }));
  }
  out.end_vector();
}

void SparseLu::append_forward(const int* rows, const double* values, int count, SparseVectors& out) {
  ++stamp_;
  for (int i = 0; i < count; ++i) start_at(position_[rows[i]], values[i]);
  append_reached(
      [this](int k, double value, const auto& put) {
        for (int e = l_begin_[k]; e < l_begin_[k + 1]; ++e) put(position_[l_row_[e]], -l_[e] * value);
        return value;
      },
      out);
}

void SparseLu::append_backward(const int* columns, const double* values, int count, SparseVectors& out) {
  if (!has_transposed_) transpose_upper();
  ++stamp_;
  for (int i = 0; i < count; ++i) start_at(step_of_column_[columns[i]], values[i]);
  append_reached(
      [this](int k, double value, const auto& put) {
        value *= inverse_pivot_[k];
        for (int e = row_begin_[k]; e < row_begin_[k + 1]; ++e) put(row_step_[e], -u_[row_place_[e]] * value);
        return value;
      },
      out);
}

void SparseLu::transpose_upper() {
  step_of_column_.resize(n_);
  for (int k = 0; k < n_; ++k) step_of_column_[order_[k]] = k;
  row_begin_.assign(n_ + 1, 0);
  for (const int position : u_position_) ++row_begin_[position + 1];
  std::partial_sum(row_begin_.begin(), row_begin_.end(), row_begin_.begin());
  row_next_.assign(row_begin_.begin(), row_begin_.end());
  row_step_.reserve(u_.capacity());
  row_place_.reserve(u_.capacity());
  row_step_.resize(u_.size());
  row_place_.resize(u_.size());
  for (int k = 0; k < n_; ++k)
    for (int e = u_begin_[k]; e < u_begin_[k + 1]; ++e) {
      const int at = row_next_[u_position_[e]]++;
      row_step_[at] = k;
      row_place_[at] = e;
    }
  has_transposed_ = true;
}

} // namespace steplap
