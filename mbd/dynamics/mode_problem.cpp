// Computes the matrices of the mode problem: the relative accelerations along the rows of the candidates, and those caused by unit forces
// along each other row, with all other elements in their present modes.
#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

namespace {

// Rounding errors of a relative acceleration: absolute, m/s² or rad/s², and relative to its terms.
constexpr double k_least_acceleration = 1e-11;
constexpr double k_rounded_share = 1e-12;

// Relative acceleration along a row for the accelerations `a` of the clusters, and the sum of its absolute terms.
struct AlongRow {
  double acceleration = 0.0, terms = 0.0;
};

AlongRow along_row(const SchurRow& row, double bias, const double* a) {
  AlongRow sum{bias, std::abs(bias)};
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0)
      for (int k = 0; k < 3; ++k) {
        const double term = row.j[side][k] * a[3 * row.body[side] + k];
        sum.acceleration += term;
        sum.terms += std::abs(term);
      }
  return sum;
}

} // namespace

void Dynamics::relative_motion(int f, const double* dy, double* rate, double* acceleration, double* rounding) {
  need(ResultLevel::rates);
  ensure_byproducts();
  const FrictionElement& friction = *system_.frictions[f].friction;
  const RowSpec* specs = friction.rows(state_->friction[f]);
  kinematics_.complete();
  const double* const a = cluster_accelerations(dy);
  for (int r = 0; r < friction.dimension(); ++r) {
    rate[r] = acceleration[r] = 0.0;
    rounding[r] = k_least_acceleration;
    for (const RowSpec* part = &specs[r]; part; part = part->next) {
      SchurRow row;
      const auto m = rows_.load(*part, row);
      const AlongRow along = along_row(row, m.bias, a);
      rate[r] += m.rate;
      acceleration[r] += along.acceleration;
      rounding[r] += k_rounded_share * along.terms;
    }
  }
}

// Row of a candidate in the coordinates of a layout: those of clusters or, for a side in a mechanism, those of the mechanism. A row between
// two clusters of one mechanism is stored in its first side only.
struct Dynamics::CandidateRow {
  SchurRow row;
  const Mechanism* mechanism[2] = {nullptr, nullptr};
  double gradient[2][Mechanism::k_most] = {}; ///< J
  double response[2][Mechanism::k_most] = {}; ///< M⁻¹ Jᵀ

  void reduce(const Layout& layout) {
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < layout.absolute_count) continue;
      mechanism[side] = &layout.mechanism_of_cluster(row.body[side]);
      SchurRow half = row;
      if (side == 1 && mechanism[0] == mechanism[1]) { // the first side contains both
        mechanism[1] = nullptr;
        row.body[1] = -1;
        continue;
      }
      if (const int other = row.body[1 - side];
          other >= 0 && (other < layout.absolute_count || &layout.mechanism_of_cluster(other) != mechanism[side]))
        half.body[1 - side] = -1;
      mechanism[side]->reduce(half, gradient[side]);
      std::copy_n(gradient[side], Mechanism::k_most, response[side]);
      mechanism[side]->solve_mass(response[side]);
    }
  }
  [[nodiscard]] double along(const double* a) const {
    double sum = 0.0;
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      if (const Mechanism* m = mechanism[side])
        for (int i = 0; i < m->size(); ++i) sum += gradient[side][i] * a[m->first_coordinate + i];
      else
        for (int k = 0; k < 3; ++k) sum += row.j[side][k] * a[3 * row.body[side] + k];
    }
    return sum;
  }
  void add_response(double f, double* a) const {
    for (int side = 0; side < 2; ++side) {
      if (row.body[side] < 0) continue;
      if (const Mechanism* m = mechanism[side])
        for (int i = 0; i < m->size(); ++i) a[m->first_coordinate + i] += f * response[side][i];
      else
        for (int k = 0; k < 3; ++k) a[3 * row.body[side] + k] += f * row.wj[side][k];
    }
  }
};

void Dynamics::compute_mode_problem(ModeProblem& candidates, const double* dy) {
  need(ResultLevel::rates);
  ensure_byproducts();
  Layout& layout = *layout_;
  const std::size_t n = candidates.rows.size();
  candidates.compliance.assign(n * n, 0.0);
  candidates.acceleration.assign(n, 0.0);
  candidates.rounding.assign(n, 0.0);
  kinematics_.complete();
  std::vector<std::vector<CandidateRow>> rows(n); // each row is the sum of its parts
  std::vector<double> response(coordinate_count());
  const double* const a = cluster_accelerations(dy);
  for (std::size_t c = 0; c < n; ++c) {
    candidates.rounding[c] = k_least_acceleration;
    for (const RowSpec* part = candidates.rows[c]; part; part = part->next) {
      CandidateRow& row = rows[c].emplace_back();
      const auto m = rows_.load(*part, row.row);
      const AlongRow along = along_row(row.row, m.bias, a);
      candidates.acceleration[c] += along.acceleration;
      candidates.rounding[c] += k_rounded_share * along.terms;
      row.reduce(layout);
    }
  }
  for (std::size_t c = 0; c < n; ++c) {
    std::fill(response.begin(), response.end(), 0.0);
    for (const CandidateRow& part : rows[c]) part.add_response(1.0, response.data());
    if (!layout.active.empty()) {
      for (std::size_t r = 0; r < layout.active.size(); ++r) row_scratch_[r] = rows_.along(r, response.data());
      rows_.take_away(row_scratch_.data(), response.data());
    }
    for (std::size_t d = 0; d < n; ++d)
      for (const CandidateRow& part : rows[d]) candidates.compliance[d * n + c] += part.along(response.data());
  }
}

} // namespace steplap
