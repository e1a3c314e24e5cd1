#include "mbd/rest/freedom.h"

#include "mbd/dynamics/schur.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace steplap {

namespace {

// Least coefficient, for rows of unit length, with which a row counts as part of a dependency; smaller ones are rounding.
constexpr double k_part = 1e-6;

class Rows {
public:
  explicit Rows(const System& system) : system_(system) {
    const State state = system.initial_state();
    place_bodies(state.q, state.v, motion_);
  }

  void add(const RowSpec& spec) {
    for (const RowSpec* part = spec.next; part; part = part->next) further_.push_back({part, size()});
    rows_.push_back(sides_of(spec));
  }

  void factor() {
    if (rows_.empty()) return;
    whole_ = rows_;
    parts_.clear();
    for (const auto& [part, of] : further_) {
      parts_.push_back({static_cast<int>(whole_.size()), of});
      whole_.push_back(sides_of(*part));
    }
    solver_ = {};
    solver_.analyze(whole_, size(), parts_);
    solver_.factor(whole_);
  }

  [[nodiscard]] SchurRow sides_of(const RowSpec& spec) const {
    const RowGradient<double> gradient = row_gradient(spec, motion_[spec.a], motion_[spec.b]);
    SchurRow row;
    const int body[2] = {spec.a, spec.b};
    for (int side = 0; side < 2; ++side) {
      if (body[side] == k_ground || body[0] == body[1]) continue;
      const BodyData& of = system_.bodies[body[side]];
      row.body[side] = body[side] - 1;
      for (int c = 0; c < 3; ++c) {
        row.w[side][c] = 1.0 / (c < 2 ? of.mass : of.inertia);
        row.j[side][c] = gradient.side(side)[c];
        row.wj[side][c] = row.w[side][c] * row.j[side][c];
      }
    }
    return row;
  }

  [[nodiscard]] int size() const { return static_cast<int>(rows_.size()); }

  [[nodiscard]] std::vector<int> dependent() const {
    std::vector<int> list;
    for (int i = 0; i < size(); ++i)
      if (solver_.is_dependent(i)) list.push_back(i);
    return list;
  }

  // Marks the rows that have a coefficient in some dependency J_dᵀ = Σ c J_rᵀ. All dependencies are added with random factors and solved at
  // once. A second sum with other factors finds terms that cancel in the first one.
  [[nodiscard]] std::vector<char> find_shared(const std::vector<int>& dependent) const {
    std::vector<char> is_shared(rows_.size(), 0);
    for (const int d : dependent) is_shared[d] = 1;
    if (dependent.empty()) return is_shared;
    for (const double turn : {0.6180339887498949, 0.4142135623730950}) {
      std::vector<double> factor(rows_.size(), 0.0);
      for (std::size_t k = 0; k < dependent.size(); ++k) {
        const double x = turn * static_cast<double>(k + 1);
        factor[dependent[k]] = (0.5 + x - std::floor(x)) / length(dependent[k]);
      }
      std::vector<double> part = gram(factor);
      for (const int d : dependent) part[d] = 0.0;
      solver_.solve(whole_, part.data());
      for (std::size_t r = 0; r < rows_.size(); ++r)
        if (std::abs(part[r]) * length(static_cast<int>(r)) > k_part) is_shared[r] = 1;
    }
    return is_shared;
  }

private:
  [[nodiscard]] double length(int r) const {
    double sum = 0.0;
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) sum += rows_[r].wj[side][c] * rows_[r].j[side][c];
    auto part = std::lower_bound(parts_.begin(), parts_.end(), r, [](const SchurPart& p, int row) { return p.of < row; });
    if (part == parts_.end() || part->of != r) return std::sqrt(sum);
    std::map<int, double> wj, j; // by coordinate; if several parts of a row act on a body, their sum
    const auto add = [&](const SchurRow& row) {
      for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3 && row.body[side] >= 0; ++c) {
          wj[3 * row.body[side] + c] += row.wj[side][c];
          j[3 * row.body[side] + c] += row.j[side][c];
        }
    };
    for (add(rows_[r]); part != parts_.end() && part->of == r; ++part) add(whole_[part->row]);
    sum = 0.0;
    for (const auto& [at, value] : wj) sum += value * j[at];
    return std::sqrt(sum);
  }

  // Returns J W Jᵀ x.
  [[nodiscard]] std::vector<double> gram(const std::vector<double>& x) const {
    std::vector<double> response(3 * system_.bodies.size(), 0.0), result(rows_.size(), 0.0);
    const auto for_entries = [this](const auto& f) {
      for (std::size_t i = 0; i < whole_.size(); ++i)
        for (int side = 0; side < 2; ++side)
          for (int c = 0; c < 3 && whole_[i].body[side] >= 0; ++c)
            f(i < rows_.size() ? i : static_cast<std::size_t>(parts_[i - rows_.size()].of), whole_[i], side, c);
    };
    for_entries([&](std::size_t r, const SchurRow& row, int side, int c) { response[3 * row.body[side] + c] += row.wj[side][c] * x[r]; });
    for_entries(
        [&](std::size_t r, const SchurRow& row, int side, int c) { result[r] += row.j[side][c] * response[3 * row.body[side] + c]; });
    return result;
  }

  const System& system_;
  std::vector<Motion<double>> motion_;
  std::vector<SchurRow> rows_;
  std::vector<std::pair<const RowSpec*, int>> further_; // further parts of rows, with the index of the row
  std::vector<SchurRow> whole_;                         // rows, then their further parts
  std::vector<SchurPart> parts_;
  SchurSolver solver_;
};

// Returns the marked rows as reactions, by element. Only those of joints and drives, the first `joint_rows`, have quantities.
std::vector<SharedReaction> reactions_of(const System& system, const std::vector<char>& is_shared, const std::vector<int>& elements) {
  std::map<int, std::vector<std::string>> found;
  for (std::size_t i = 0; i < is_shared.size(); ++i) {
    if (!is_shared[i]) continue;
    std::vector<std::string>& quantities = found[elements[i]];
    if (i < system.rows.size()) quantities.emplace_back(system.rows[i].quantity);
  }
  std::vector<SharedReaction> result;
  for (auto& [element, quantities] : found) result.push_back({element, std::move(quantities)});
  return result;
}

} // namespace

DegreesOfFreedom count_freedom(const System& system) {
  DegreesOfFreedom freedom;
  freedom.coordinates = 3 * (system.body_count() - 1);
  freedom.rows = static_cast<int>(system.rows.size());
  Rows rows(system);
  std::vector<int> elements;
  for (const RowSpec& row : system.rows) {
    rows.add(row);
    elements.push_back(row.element);
  }
  rows.factor();
  freedom.dependent_rows = rows.dependent();
  freedom.rank = rows.size() - static_cast<int>(freedom.dependent_rows.size());
  freedom.shared = reactions_of(system, rows.find_shared(freedom.dependent_rows), elements);
  if (system.frictions.empty()) {
    freedom.rank_sticking = freedom.rank;
    freedom.shared_sticking = freedom.shared;
    return freedom;
  }
  for (const FrictionUnit& unit : system.frictions) {
    if (unit.friction->is_elastic()) continue;
    for (int r = 0; r < unit.friction->dimension(); ++r) {
      rows.add(unit.friction->rows(FrictionState{})[r]);
      elements.push_back(unit.element);
    }
  }
  rows.factor();
  const std::vector<int> dependent = rows.dependent();
  freedom.rank_sticking = rows.size() - static_cast<int>(dependent.size());
  freedom.shared_sticking = reactions_of(system, rows.find_shared(dependent), elements);
  return freedom;
}

} // namespace steplap
