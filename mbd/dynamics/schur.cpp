#include "mbd/dynamics/schur.h"
#include "mbd/base/diagnostics.h"
#include "mbd/base/types.h"
#include "mbd/dynamics/dense_elimination.h"
#include "mbd/dynamics/dependent_rows.h"
#include "mbd/dynamics/hub_solver.h"
#include "mbd/dynamics/refinement.h"
#include "mbd/system/motion.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace steplap {

// Rows i and j share a body, which is on side_i of row i and on side_j of row j.
struct SchurCoupling {
  int i, j;
  unsigned char side_i, side_j;
};

namespace {

using Pattern = Eigen::SparseMatrix<double>;

// If all relative pivots are above this limit, no row nearly depends on others, and dependent_friction() is not called. The limit allows
// for SchurSolver::k_dependent² and for rows that contribute only 1/100 to a dependence.
constexpr double k_doubtful_pivot = 1e-8;

// Returns a component of the gradient in the metric of W, in which the squared length of the gradient is the row's diagonal element of A.
double weighted(const SchurRow& row, int side, int c) { return row.w[side][c] > 0.0 ? row.j[side][c] * std::sqrt(row.w[side][c]) : 0.0; }

double squared_length(const SchurRow& row) {
  double sum = 0.0;
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0)
      for (int c = 0; c < 3; ++c) sum += weighted(row, side, c) * weighted(row, side, c);
  return sum;
}

int count_bodies(const std::vector<SchurRow>& rows, int n, const std::vector<SchurPart>& parts) {
  int count = 0;
  for (const SchurRow& row : std::span(rows).first(n)) count = std::max({count, row.body[0] + 1, row.body[1] + 1});
  for (const SchurPart& part : parts) count = std::max({count, rows[part.row].body[0] + 1, rows[part.row].body[1] + 1});
  return count;
}

std::vector<SchurCoupling> couplings(const std::vector<SchurRow>& rows, int n, const std::vector<SchurPart>& parts, int body_count) {
  std::vector<std::vector<std::pair<int, unsigned char>>> at_body(body_count);
  const auto enter = [&](int i) {
    for (unsigned char side = 0; side < 2; ++side)
      if (rows[i].body[side] >= 0) at_body[rows[i].body[side]].push_back({i, side});
  };
  for (int i = 0; i < n; ++i) enter(i);
  for (const SchurPart& part : parts) enter(part.row);
  std::vector<SchurCoupling> result;
  for (const auto& members : at_body)
    for (const auto& [i, side_i] : members)
      for (const auto& [j, side_j] : members) result.push_back({i, j, side_i, side_j});
  return result;
}

// Returns for each entry of `rows` the row to which it belongs: itself, or that of which it is a part.
std::vector<int> rows_of(std::size_t count, const std::vector<SchurPart>& parts) {
  std::vector<int> of(count);
  std::iota(of.begin(), of.end(), 0);
  for (const SchurPart& part : parts) of[part.row] = part.of;
  return of;
}

std::vector<int> fill_reducing_order(int n, const std::vector<SchurCoupling>& coupled, const std::vector<int>& of) {
  std::vector<Eigen::Triplet<double>> entries;
  for (const SchurCoupling& c : coupled) entries.emplace_back(of[c.i], of[c.j], 1.0);
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1.0);
  Pattern pattern(n, n);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation(n);
  Eigen::AMDOrdering<int> ordering;
  ordering(pattern, permutation);
  std::vector<int> order(n);
  for (int k = 0; k < n; ++k) order[k] = permutation.indices()[k];
  return order;
}

} // namespace

namespace {

// Returns the position of a number in the array of rows, in doubles from the start of the first row. `member`: byte offset of the array in
// SchurRow.
std::uint16_t place_in_rows(int row, std::size_t member, int side) {
  const std::size_t at = (row * sizeof(SchurRow) + member) / sizeof(double) + 3 * side;
  if (at > std::numeric_limits<std::uint16_t>::max()) // only parts of rows can have such a large index
    throw NumericalFailure("ropes over so many points that move are too much for so few other constraints: give them a 'stiffness'");
  return static_cast<std::uint16_t>(at);
}

} // namespace

void SchurSolver::list_dense_products(const std::vector<SchurRow>& rows, const std::vector<SchurCoupling>& coupled,
                                      const std::vector<int>& of) {
  for (int k = 0; k < n_; ++k) position_[k] = k;
  dense_products_.clear();
  dense_turns_.clear();
  dense_constant_.fill(0.0);
  for (const SchurCoupling& c : coupled) {
    if (of[c.j] > of[c.i]) continue;
    const SchurRow &row = rows[c.i], &other = rows[c.j];
    const auto entry = static_cast<std::uint16_t>(of[c.i] * n_ + of[c.j]);
    const DenseProduct product{entry, place_in_rows(c.i, offsetof(SchurRow, wj), c.side_i),
                               place_in_rows(c.j, offsetof(SchurRow, j), c.side_j)};
    if (row.is_constant && other.is_constant) dense_constant_[entry] += row.wj[c.side_i][2] * other.j[c.side_j][2];
    else (row.is_constant || other.is_constant ? dense_turns_ : dense_products_).push_back(product);
  }
}

// Upper triangle of the permuted matrix by columns, with the products whose sum is A(i, k), i ≤ k.
struct SchurSolver::Columns {
  std::vector<std::vector<Product>> of_rows;
  std::vector<std::vector<PartProduct>> of_parts; // empty without parts
};

SchurSolver::Columns SchurSolver::columns_of(const std::vector<SchurCoupling>& coupled, const std::vector<int>& of, bool has_parts) const {
  Columns columns;
  columns.of_rows.resize(n_);
  columns.of_parts.resize(has_parts ? n_ : 0);
  for (const SchurCoupling& c : coupled) {
    const int k = position_[of[c.i]], i = position_[of[c.j]];
    if (i > k) continue;
    const Product product{c.j, i, c.side_i, c.side_j};
    if (c.i < n_) columns.of_rows[k].push_back(product);
    else columns.of_parts[k].push_back({c.i, product});
  }
  for (auto& column : columns.of_rows)
    std::sort(column.begin(), column.end(), [](const Product& x, const Product& y) { return x.position < y.position; });
  return columns;
}

void SchurSolver::list_products(const Columns& columns) {
  product_begin_.assign(1, 0);
  products_.clear();
  for (const auto& column : columns.of_rows) {
    products_.insert(products_.end(), column.begin(), column.end());
    product_begin_.push_back(static_cast<int>(products_.size()));
  }
  part_begin_.assign(1, 0);
  part_products_.clear();
  for (const auto& column : columns.of_parts) {
    part_products_.insert(part_products_.end(), column.begin(), column.end());
    part_begin_.push_back(static_cast<int>(part_products_.size()));
  }
}

// Computes the elimination tree and the pattern of each row of L (T. A. Davis, Direct Methods for Sparse Linear Systems, §4.1): row k of L
// is the union of the paths from each i with A(i, k) ≠ 0 up to k.
void SchurSolver::find_pattern_of_factors(const Columns& columns) {
  std::vector<int> parent(n_, -1), mark(n_, -1), length(n_, 0);
  pattern_begin_.assign(1, 0);
  pattern_.clear();
  for (int k = 0; k < n_; ++k) {
    mark[k] = k;
    const auto enter = [&](int from) {
      for (int i = from; mark[i] != k; i = parent[i]) {
        if (parent[i] < 0) parent[i] = k;
        mark[i] = k;
        pattern_.push_back(i);
        ++length[i];
      }
    };
    for (const Product& p : columns.of_rows[k]) enter(p.position);
    if (!columns.of_parts.empty())
      for (const PartProduct& p : columns.of_parts[k]) enter(p.product.position);
    std::sort(pattern_.begin() + pattern_begin_.back(), pattern_.end());
    pattern_begin_.push_back(static_cast<int>(pattern_.size()));
  }
  column_begin_.assign(1, 0);
  for (int k = 0; k < n_; ++k) column_begin_.push_back(column_begin_[k] + length[k]);
  column_row_.assign(column_begin_.back(), 0);
  std::vector<int> next(column_begin_.begin(), column_begin_.end() - 1);
  for (int k = 0; k < n_; ++k)
    for (int p = pattern_begin_[k]; p < pattern_begin_[k + 1]; ++p) column_row_[next[pattern_[p]]++] = k;
}

SchurSolver::SchurSolver() = default;
SchurSolver::~SchurSolver() = default;
SchurSolver::SchurSolver(SchurSolver&&) noexcept = default;
SchurSolver& SchurSolver::operator=(SchurSolver&&) noexcept = default;

void SchurSolver::analyze(const std::vector<SchurRow>& rows, int count, const std::vector<SchurPart>& parts, HubElimination hubs) {
  n_ = count;
  parts_ = parts;
  length_ = std::max(1.0, n_ / k_usual_rows);
  body_count_ = count_bodies(rows, n_, parts);
  right_.assign(n_, 0.0);
  correction_.assign(n_, 0.0);
  response_.assign(3 * static_cast<std::size_t>(body_count_), 0.0);
  position_.resize(n_);
  inverse_d_.assign(n_, 0.0);
  is_by_hubs_ = is_pattern_known_ = false;
  hubs_ = hubs == HubElimination::apart && parts.empty() ? HubSolver::of(rows, count) : nullptr;
  if (!hubs_) find_pattern(rows);
}

void SchurSolver::find_pattern(const std::vector<SchurRow>& rows) {
  is_pattern_known_ = true;
  const std::vector<SchurCoupling> coupled = couplings(rows, n_, parts_, body_count_);
  const std::vector<int> of = rows_of(rows.size(), parts_);
  if (n_ <= k_max_dense) {
    list_dense_products(rows, coupled, of);
    return;
  }
  order_ = fill_reducing_order(n_, coupled, of);
  for (int k = 0; k < n_; ++k) position_[order_[k]] = k;
  const Columns columns = columns_of(coupled, of, !parts_.empty());
  list_products(columns);
  find_pattern_of_factors(columns);
  column_fill_.assign(n_, 0);
  l_.assign(column_begin_.back(), 0.0);
  work_.assign(n_, 0.0);
  permuted_.assign(n_, 0.0);
}

void SchurSolver::decide_rank(const std::vector<char>& is_friction, const std::vector<char>& was_out) {
  can_stay_out_ = is_friction;
  was_dependent_ = was_out;
  out_.clear();
  is_rank_open_ = !is_friction.empty();
}

void SchurSolver::keep_rank(const std::vector<SchurRow>& rows, double shift) {
  is_rank_open_ = false;
  if (dependent_count_ == 0 && smallest_pivot_ >= k_doubtful_pivot) return;
  if (!is_rank_uncertain(rows)) { // the rows left out act on nothing that can move
    out_.assign(n_, 0);
    for (int r = 0; r < n_; ++r) out_[r] = can_stay_out_[r] != 0 && is_dependent(r);
    return;
  }
  out_ = dependent_friction(rows);
  factor_as_is(rows, shift);
}

bool SchurSolver::is_rank_uncertain(const std::vector<SchurRow>& rows) const {
  if (smallest_pivot_ < k_doubtful_pivot) return true;
  for (int r = 0; r < n_; ++r)
    if (is_dependent(r) && squared_length(rows[r]) > 0.0) return true;
  return std::any_of(parts_.begin(), parts_.end(),
                     [&](const SchurPart& part) { return is_dependent(part.of) && squared_length(rows[part.row]) > 0.0; });
}

std::vector<char> SchurSolver::dependent_friction(const std::vector<SchurRow>& rows) const {
  std::vector<WeightedRow> in_masses(n_);
  const auto add = [&](int of, const SchurRow& part) {
    for (int side = 0; side < 2; ++side)
      if (part.body[side] >= 0)
        for (int c = 0; c < 3; ++c) in_masses[of].row[3 * part.body[side] + c] += weighted(part, side, c);
  };
  for (int r = 0; r < n_; ++r) {
    in_masses[r].row = VecX::Zero(3 * static_cast<Eigen::Index>(body_count_));
    add(r, rows[r]);
  }
  for (const SchurPart& part : parts_) add(part.of, rows[part.row]);
  for (WeightedRow& row : in_masses) row.length = row.row.norm();
  return dependent_rows(in_masses, can_stay_out_.data(), was_dependent_);
}

void SchurSolver::factor(const std::vector<SchurRow>& rows, double shift) {
  factor_as_is(rows, shift);
  if (is_rank_open_) [[unlikely]]
    keep_rank(rows, shift);
}

// Factorises the equation of a single row, which cannot depend on others.
template <> void SchurSolver::factor_dense<1>(const std::vector<SchurRow>& rows) {
  const auto* const first = reinterpret_cast<const double*>(rows.data());
  double sum = dense_constant_[0];
  for (const DenseProduct& p : dense_products_) {
    const double* const a = first + p.wj;
    const double* const b = first + p.j;
    sum += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  for (const DenseProduct& p : dense_turns_) sum += first[p.wj + 2] * first[p.j + 2];
  const double d = sum * (1.0 + shift_);
  const bool is_out = leaves_out(0, d, d);
  smallest_pivot_ = 1.0;
  dependent_count_ = is_out ? 1 : 0;
  inverse_d_[0] = is_out ? 0.0 : 1.0 / d;
}

void SchurSolver::factor_as_is(const std::vector<SchurRow>& rows, double shift) {
  shift_ = shift;
  is_by_hubs_ = hubs_ && shift == 0.0 && out_.empty() && hubs_->factor(rows);
  if (is_by_hubs_) {
    dependent_count_ = 0;
    smallest_pivot_ = hubs_->smallest_pivot() / length_;
    std::fill(inverse_d_.begin(), inverse_d_.end(), 1.0); // no row depends on others
    return;
  }
  if (!is_pattern_known_) [[unlikely]]
    find_pattern(rows);
  switch (n_) {
  case 0: break;
  case 1: factor_dense<1>(rows); break;
  case 2: factor_dense<2>(rows); break;
  case 3: factor_dense<3>(rows); break;
  case 4: factor_dense<4>(rows); break;
  default:
    if (n_ <= k_max_dense) factor_dense<0>(rows);
    else factor_sparse(rows);
  }
}

// Factorises A as a dense matrix. N is the number of rows if it is known at compile time (loops are then unrolled), otherwise 0.
template <int N> void SchurSolver::factor_dense(const std::vector<SchurRow>& rows) {
  dependent_count_ = 0;
  smallest_pivot_ = 1.0;
  double* const m = dense_.data();
  const int n = N > 0 ? N : n_;
  for (int i = 0; i < n * n; ++i) m[i] = dense_constant_[i];
  const auto* const first = reinterpret_cast<const double*>(rows.data());
  for (const DenseProduct& p : dense_products_) {
    const double* a = first + p.wj;
    const double* b = first + p.j;
    m[p.entry] += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  for (const DenseProduct& p : dense_turns_) m[p.entry] += first[p.wj + 2] * first[p.j + 2];
  const auto raise = [this](double diagonal) { return diagonal * (1.0 + shift_); };
  eliminate_rows<N>(m, inverse_d_.data(), n_, raise, [this](int i, double d, double diagonal) {
    if (leaves_out(i, d, diagonal)) [[unlikely]] {
      ++dependent_count_;
      return 0.0;
    }
    if (d < smallest_pivot_ * diagonal) smallest_pivot_ = d / diagonal;
    return 1.0 / d;
  });
}

void SchurSolver::trace(const std::vector<SchurRowOf<TapeNumber>>& rows, double least_pivot, TapeNumber* x,
                        std::vector<TracedPivot>& pivots) const {
  if (!is_small()) return trace_sparse(rows, least_pivot, x, pivots);
  // Converts a position in the array of rows (place_in_rows()) back to the side.
  constexpr std::size_t k_row = sizeof(SchurRow) / sizeof(double);
  const auto side_of = [](std::size_t place, std::size_t member) { return (place % k_row - member / sizeof(double)) / 3; };
  std::array<TapeNumber, k_max_dense * k_max_dense> m;
  std::array<TapeNumber, k_max_dense> inverse_d;
  for (int i = 0; i < n_ * n_; ++i) m[i] = dense_constant_[i];
  for (const DenseProduct& p : dense_products_) {
    const TapeNumber* const a = rows[p.wj / k_row].wj[side_of(p.wj, offsetof(SchurRow, wj))];
    const TapeNumber* const b = rows[p.j / k_row].j[side_of(p.j, offsetof(SchurRow, j))];
    m[p.entry] += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  for (const DenseProduct& p : dense_turns_)
    m[p.entry] +=
        rows[p.wj / k_row].wj[side_of(p.wj, offsetof(SchurRow, wj))][2] * rows[p.j / k_row].j[side_of(p.j, offsetof(SchurRow, j))][2];
  const double least = n_ > 1 ? least_pivot : k_pivot_tolerance; // a single row cannot be nearly dependent on others
  eliminate_rows<0>(
      m.data(), inverse_d.data(), n_, [](const TapeNumber& diagonal) { return diagonal; },
      [&](int, const TapeNumber& d, const TapeNumber& diagonal) {
        if (!(d > least * diagonal)) throw NotTraceable();
        if (n_ > 1) pivots.push_back({d, diagonal});
        return TapeNumber(1.0) / d;
      });
  if (n_ == 1) x[0] *= inverse_d[0];
  else substitute<0>(m.data(), inverse_d.data(), n_, x);
}

template <int N> void SchurSolver::solve_dense(double* x) const { substitute<N>(dense_.data(), inverse_d_.data(), n_, x); }

// Adds the contributions of the further parts of row k to the entries y of row k of A.
template <class S> void SchurSolver::add_part_products(const std::vector<SchurRowOf<S>>& rows, int k, S* y) const {
  for (int p = part_begin_[k]; p < part_begin_[k + 1]; ++p) {
    const Product& product = part_products_[p].product;
    const S* a = rows[part_products_[p].part].wj[product.side_k];
    const S* b = rows[product.row].j[product.side_i];
    y[product.position] += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
}

// Factorises L D Lᵀ row by row. `fill` and `y` are scratch, one entry per column; y is zero before and after. invert(k, d, diagonal)
// returns 1/d, or 0 if the row eliminated in step k is to be left out.
template <class S, class Raise, class Invert>
STEPLAP_INLINE void SchurSolver::eliminate_pattern(const std::vector<SchurRowOf<S>>& rows, int* fill, S* y, S* l, S* inverse_d,
                                                   const Raise& raise, const Invert& invert) const {
  for (int k = 0; k < n_; ++k) fill[k] = column_begin_[k];
  for (int k = 0; k < n_; ++k) {
    const SchurRowOf<S>& row_k = rows[order_[k]];
    for (int p = product_begin_[k]; p < product_begin_[k + 1]; ++p) {
      const Product& product = products_[p];
      const S* a = row_k.wj[product.side_k];
      const S* b = rows[product.row].j[product.side_i];
      y[product.position] += a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    if (!part_products_.empty()) [[unlikely]]
      add_part_products(rows, k, y);
    const S diagonal = raise(y[k]);
    S d = diagonal;
    y[k] = S(0.0);
    for (int p = pattern_begin_[k]; p < pattern_begin_[k + 1]; ++p) {
      const int i = pattern_[p];
      const S yi = y[i];
      y[i] = S(0.0);
      const int end = fill[i];
      for (int c = column_begin_[i]; c < end; ++c) y[column_row_[c]] -= l[c] * yi;
      const S lki = yi * inverse_d[i];
      d -= lki * yi;
      l[end] = lki;
      fill[i] = end + 1;
    }
    inverse_d[k] = invert(k, d, diagonal);
  }
}

void SchurSolver::factor_sparse(const std::vector<SchurRow>& rows) {
  dependent_count_ = 0;
  double smallest_pivot = 1.0;
  const auto raise = [this](double diagonal) { return diagonal * (1.0 + shift_); };
  eliminate_pattern(rows, column_fill_.data(), work_.data(), l_.data(), inverse_d_.data(), raise, [&](int k, double d, double diagonal) {
    if (leaves_out(order_[k], d, diagonal)) [[unlikely]] {
      ++dependent_count_;
      return 0.0;
    }
    smallest_pivot = std::min(smallest_pivot, d / diagonal);
    return 1.0 / d;
  });
  smallest_pivot_ = smallest_pivot;
}

void SchurSolver::trace_sparse(const std::vector<SchurRowOf<TapeNumber>>& rows, double least_pivot, TapeNumber* x,
                               std::vector<TracedPivot>& pivots) const {
  std::vector<int> fill(column_fill_.size());
  std::vector<TapeNumber> y(work_.size(), TapeNumber(0.0)), l(l_.size()), inverse_d(inverse_d_.size());
  eliminate_pattern(
      rows, fill.data(), y.data(), l.data(), inverse_d.data(), [](const TapeNumber& diagonal) { return diagonal; },
      [&](int, const TapeNumber& d, const TapeNumber& diagonal) {
        if (!(d > least_pivot * diagonal)) throw NotTraceable();
        pivots.push_back({d / diagonal, TapeNumber(1.0)}); // the same comparison as in factor_sparse()
        return TapeNumber(1.0) / d;
      });
  substitute_pattern(l.data(), inverse_d.data(), y.data(), x);
}

void SchurSolver::solve(const std::vector<SchurRow>& rows, double* x) const {
  if (n_ == 1) {
    x[0] *= inverse_d_[0];
    return;
  }
  if (!is_near_singular() || shift_ > 0.0) [[likely]]
    return eliminate(x);
  std::copy(x, x + n_, right_.begin());
  eliminate(x);
  refine(rows, right_.data(), x);
}

template <class F> void SchurSolver::for_parts(const F& f, const std::vector<SchurRow>& rows) const {
  for (const SchurPart& part : parts_)
    for (int side = 0; side < 2; ++side)
      if (const SchurRow& row = rows[part.row]; row.body[side] >= 0) f(part, row, side, &response_[3 * row.body[side]]);
}

// Refines x by corrections A⁻¹ (right − J (W Jᵀ x)).
void SchurSolver::refine(const std::vector<SchurRow>& rows, const double* right, double* x) const {
  double* const correction = correction_.data();
  refine_solution(n_, x, [&](const double* now) {
    std::fill(response_.begin(), response_.end(), 0.0);
    for (int r = 0; r < n_; ++r)
      for (int side = 0; side < 2; ++side)
        if (rows[r].body[side] >= 0)
          for (int c = 0; c < 3; ++c) response_[3 * rows[r].body[side] + c] += rows[r].wj[side][c] * now[r];
    for_parts(
        [&](const SchurPart& part, const SchurRow& row, int side, double* response) {
          for (int c = 0; c < 3; ++c) response[c] += row.wj[side][c] * now[part.of];
        },
        rows);
    for (int r = 0; r < n_; ++r) {
      double sum = right[r];
      for (int side = 0; side < 2; ++side)
        if (rows[r].body[side] >= 0)
          for (int c = 0; c < 3; ++c) sum -= rows[r].j[side][c] * response_[3 * rows[r].body[side] + c];
      correction[r] = sum;
    }
    for_parts(
        [&](const SchurPart& part, const SchurRow& row, int side, const double* response) {
          for (int c = 0; c < 3; ++c) correction[part.of] -= row.j[side][c] * response[c];
        },
        rows);
    eliminate(correction);
    return correction;
  });
}

void SchurSolver::eliminate(double* x) const {
  switch (n_) {
  case 0: return;
  case 2: return solve_dense<2>(x);
  case 3: return solve_dense<3>(x);
  case 4: return solve_dense<4>(x);
  default: break;
  }
  if (n_ <= k_max_dense) return solve_dense<0>(x);
  if (is_by_hubs_) return hubs_->solve(x);
  eliminate_sparse(x);
}

// Solves A x = x₀ in place by substitution. `y`: scratch, one number per row.
template <class S> STEPLAP_INLINE void SchurSolver::substitute_pattern(const S* l, const S* inverse_d, S* y, S* x) const {
  for (int k = 0; k < n_; ++k) y[k] = x[order_[k]];
  for (int k = 0; k < n_; ++k)
    for (int c = column_begin_[k]; c < column_begin_[k + 1]; ++c) y[column_row_[c]] -= l[c] * y[k];
  for (int k = 0; k < n_; ++k) y[k] *= inverse_d[k];
  for (int k = n_ - 1; k >= 0; --k)
    for (int c = column_begin_[k]; c < column_begin_[k + 1]; ++c) y[k] -= l[c] * y[column_row_[c]];
  for (int k = 0; k < n_; ++k) x[order_[k]] = y[k];
}

void SchurSolver::eliminate_sparse(double* x) const { substitute_pattern(l_.data(), inverse_d_.data(), permuted_.data(), x); }

} // namespace steplap
