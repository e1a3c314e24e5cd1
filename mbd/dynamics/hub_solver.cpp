#include "mbd/dynamics/hub_solver.h"

#include "mbd/dynamics/dense_elimination.h"

#include <algorithm>
#include <utility>

namespace steplap {

namespace {

// Least number of rows at a hub. With fewer rows A is cheap to factorise. The limit also excludes all systems that can be recorded
// (SchurSolver::can_be_traced), which need a single method of solution.
constexpr int k_fewest_rows = 32;
// Least relative pivot for this method. Above it, B loses at most two digits compared with A, and the pose is not near a singular position.
constexpr double k_least_pivot = 0.05;

std::vector<int> rows_at_bodies(const std::vector<SchurRow>& rows, int count) {
  std::vector<int> at_body;
  for (int r = 0; r < count; ++r)
    for (const int body : rows[r].body) {
      if (body < 0) continue;
      if (at_body.size() <= static_cast<std::size_t>(body)) at_body.resize(body + 1, 0);
      ++at_body[body];
    }
  return at_body;
}

double length_of(const SchurRow& row, int side) {
  return row.wj[side][0] * row.j[side][0] + row.wj[side][1] * row.j[side][1] + row.wj[side][2] * row.j[side][2];
}

} // namespace

std::unique_ptr<HubSolver> HubSolver::of(const std::vector<SchurRow>& rows, int count) {
  if (count <= SchurSolver::k_usual_rows) return nullptr;
  const std::vector<int> at_body = rows_at_bodies(rows, count);
  std::vector<int> hub_of(at_body.size(), -1);
  int hubs = 0, outer = 0;
  for (std::size_t b = 0; b < at_body.size(); ++b)
    if (at_body[b] >= k_fewest_rows) hub_of[b] = hubs++;
  if (hubs == 0 || hubs > k_most_hubs) return nullptr;
  const auto is_hub = [&](int body) { return body < 0 || hub_of[body] >= 0; };
  for (int r = 0; r < count; ++r) {
    if (rows[r].body[0] == rows[r].body[1]) return nullptr; // a row inside one body is coupled to no other
    if (is_hub(rows[r].body[0]) && is_hub(rows[r].body[1])) ++outer;
  }
  if (outer > k_most_outer) return nullptr;
  return std::unique_ptr<HubSolver>(new HubSolver(rows, count, hub_of));
}

HubSolver::HubSolver(const std::vector<SchurRow>& rows, int count, const std::vector<int>& hub_of) : hub_of_(hub_of) {
  for (const int hub : hub_of_) hub_count_ = std::max(hub_count_, hub + 1);
  stiffness_.fill(1.0);
  for (int r = 0; r < count; ++r) {
    SchurRow own = rows[r];
    bool is_inner = false;
    for (int side = 0; side < 2; ++side) {
      if (own.body[side] < 0) continue;
      const int hub = hub_of_[own.body[side]];
      is_inner = is_inner || hub < 0;
      for (int c = 0; c < 3 && hub >= 0; ++c)
        if (own.w[side][c] > 0.0) stiffness_[3 * hub + c] = 1.0 / own.w[side][c];
      if (hub >= 0) own.body[side] = -1;
    }
    (is_inner ? inner_ : outer_).push_back(r);
    if (is_inner) numbers_.push_back(own);
  }
  solver_.analyze(numbers_);
  seen_.assign(3 * static_cast<std::size_t>(hub_count_) * inner_.size(), 0.0);
  moved_ = seen_;
  right_.assign(inner_.size(), 0.0);
}

// Adds the row's gradient by the coordinates of the hubs, which is a row of U, to `of_coordinates`.
void HubSolver::add_sides(const SchurRow& row, double* of_coordinates) const {
  for (int side = 0; side < 2; ++side) {
    const int hub = row.body[side] < 0 ? -1 : hub_of_[row.body[side]];
    for (int c = 0; c < 3 && hub >= 0; ++c)
      if (row.w[side][c] > 0.0) of_coordinates[3 * hub + c] += row.j[side][c];
  }
}

// Computes B and U. Returns the smallest ratio of a diagonal element of B to that of A.
double HubSolver::take_numbers(const std::vector<SchurRow>& rows) {
  const std::size_t n = inner_.size();
  double least = 1.0;
  std::fill(seen_.begin(), seen_.end(), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const SchurRow& row = rows[inner_[i]];
    double of_hubs = 0.0, of_others = 0.0;
    for (int side = 0; side < 2; ++side) {
      std::copy_n(row.j[side], 3, numbers_[i].j[side]);
      std::copy_n(row.wj[side], 3, numbers_[i].wj[side]);
      if (row.body[side] >= 0) (hub_of_[row.body[side]] >= 0 ? of_hubs : of_others) += length_of(row, side);
    }
    if (of_hubs > 0.0) least = std::min(least, of_others / (of_others + of_hubs));
    std::array<double, 3 * k_most_hubs> seen{};
    add_sides(row, seen.data());
    for (int c = 0; c < 3 * hub_count_; ++c) seen_[c * n + i] = seen[c];
  }
  for (std::size_t o = 0; o < outer_.size(); ++o) {
    const SchurRow& row = rows[outer_[o]];
    own_[o] = 0.0;
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0) own_[o] += length_of(row, side);
    outer_seen_[o].fill(0.0);
    add_sides(row, outer_seen_[o].data());
  }
  return least;
}

bool HubSolver::factor(const std::vector<SchurRow>& rows) {
  const double share = take_numbers(rows);
  if (!(share >= k_least_pivot)) return false;
  solver_.factor(numbers_);
  if (solver_.is_singular()) return false;
  smallest_pivot_ = share * solver_.smallest_pivot();
  if (!(smallest_pivot_ >= k_least_pivot)) return false;
  moved_ = seen_;
  for (int c = 0; c < 3 * hub_count_; ++c) solver_.solve(numbers_, moved_.data() + c * inner_.size());
  fill_end();
  smallest_pivot_ = std::min(smallest_pivot_, eliminate_end());
  return smallest_pivot_ >= k_least_pivot;
}

// Computes the end system: W⁻¹ + Uᵀ B⁻¹ U, and below it the rows of U for outer rows.
void HubSolver::fill_end() {
  const std::size_t n = inner_.size();
  const int hubs = 3 * hub_count_, ends = hubs + static_cast<int>(outer_.size());
  for (int c = 0; c < hubs; ++c)
    for (int d = 0; d <= c; ++d) {
      double sum = c == d ? stiffness_[c] : 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += seen_[c * n + i] * moved_[d * n + i];
      end_[c * ends + d] = sum;
    }
  for (int o = hubs; o < ends; ++o)
    for (int d = 0; d <= o; ++d) end_[o * ends + d] = d < hubs ? outer_seen_[o - hubs][d] : 0.0;
}

// Factorises the end system. Returns the smallest pivot of an outer row, relative to the row's diagonal element of A.
double HubSolver::eliminate_end() {
  const int hubs = 3 * hub_count_, ends = hubs + static_cast<int>(outer_.size());
  double least = 1.0;
  eliminate_rows<0>(
      end_.data(), inverse_d_.data(), ends, [](double diagonal) { return diagonal; },
      [&](int i, double d, double) {
        if (i >= hubs) least = std::min(least, -d > 0.0 ? -d / own_[i - hubs] : 0.0);
        return 1.0 / d;
      });
  return least;
}

void HubSolver::solve(double* x) const {
  const std::size_t n = inner_.size();
  const int hubs = 3 * hub_count_, ends = hubs + static_cast<int>(outer_.size());
  for (std::size_t i = 0; i < n; ++i) right_[i] = x[inner_[i]];
  solver_.solve(numbers_, right_.data());
  std::array<double, k_most_ends> z{};
  for (int c = 0; c < hubs; ++c)
    for (std::size_t i = 0; i < n; ++i) z[c] += seen_[c * n + i] * right_[i];
  for (int o = hubs; o < ends; ++o) z[o] = x[outer_[o - hubs]];
  substitute<0>(end_.data(), inverse_d_.data(), ends, z.data());
  for (std::size_t i = 0; i < n; ++i) {
    double sum = right_[i];
    for (int c = 0; c < hubs; ++c) sum -= moved_[c * n + i] * z[c];
    x[inner_[i]] = sum;
  }
  for (int o = hubs; o < ends; ++o) x[outer_[o - hubs]] = -z[o];
}

} // namespace steplap
