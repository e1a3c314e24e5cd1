// The matrices of the problem that decides which friction sticks: how the candidates' rows answer forces
// along one another, everything else as it is in the present modes.
#include "mbd/dynamics/dynamics.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// What is not known of a relative acceleration: absolute, m/s² or rad/s², and of its terms.
constexpr double k_least_acceleration = 1e-11;
constexpr double k_rounded_share = 1e-12;

// Relative acceleration along a row with accelerations `a` of the clusters, and the size of its terms.
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

// Gradient in the clusters' coordinates; returns the measure, its bias that of the clusters.
MeasureValue<double> Dynamics::load_candidate(const RowSpec& spec, SchurRow& row) const {
  auto m = evaluate_row<true>(spec, motion_.data());
  row.body[0] = layout_->placements[spec.a].cluster;
  row.body[1] = layout_->placements[spec.b].cluster;
  for (int side = 0; side < 2; ++side)
    if (row.body[side] >= 0) std::copy_n(layout_->clusters[row.body[side]].w, 3, row.w[side]);
  to_clusters(spec, m, row);
  m.bias = cluster_bias(spec, m);
  return m;
}

void Dynamics::slip_motion(int f, const double* dy, double* rate, double* acceleration, double* rounding) {
  const FrictionElement& friction = *system_.frictions[f].friction;
  const RowSpec* specs = friction.rows(state_->friction[f]);
  for (const int body : {specs[0].a, specs[0].b})
    if (body != k_ground) place_member(body);
  for (int r = 0; r < friction.dimension(); ++r) {
    SchurRow row;
    const auto m = load_candidate(specs[r], row);
    const AlongRow along = along_row(row, m.bias, dy + coordinate_count());
    rate[r] = m.rate;
    acceleration[r] = along.acceleration;
    rounding[r] = k_least_acceleration + k_rounded_share * along.terms;
  }
}

void Dynamics::respond(Candidates& candidates, const double* dy) {
  Layout& layout = *layout_;
  const std::size_t n = candidates.rows.size();
  const int coordinates = coordinate_count();
  candidates.compliance.assign(n * n, 0.0);
  candidates.acceleration.assign(n, 0.0);
  candidates.rounding.assign(n, 0.0);
  for (int i = 1; i < system_.body_count(); ++i) place_member(i);
  std::vector<SchurRow> rows(n);
  std::vector<double> response(coordinates), lambda(layout.active.size());
  for (std::size_t c = 0; c < n; ++c) {
    const auto m = load_candidate(*candidates.rows[c], rows[c]);
    const AlongRow along = along_row(rows[c], m.bias, dy + coordinates);
    candidates.acceleration[c] = along.acceleration;
    candidates.rounding[c] = k_least_acceleration + k_rounded_share * along.terms;
  }
  const auto along = [&](const SchurRow& row, const std::vector<double>& a) {
    double sum = 0.0;
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int k = 0; k < 3; ++k) sum += row.j[side][k] * a[3 * row.body[side] + k];
    return sum;
  };
  const auto add_response = [&](const SchurRow& row, double f) {
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0)
        for (int k = 0; k < 3; ++k) response[3 * row.body[side] + k] += f * row.wj[side][k];
  };
  for (std::size_t c = 0; c < n; ++c) {
    std::fill(response.begin(), response.end(), 0.0);
    add_response(rows[c], 1.0);
    if (!layout.active.empty()) {
      for (std::size_t r = 0; r < layout.active.size(); ++r)
        lambda[r] = -along(layout.schur_rows[r], response);
      layout.schur.solve(layout.schur_rows, lambda.data());
      for (std::size_t r = 0; r < layout.active.size(); ++r) add_response(layout.schur_rows[r], lambda[r]);
    }
    for (std::size_t d = 0; d < n; ++d) candidates.compliance[d * n + c] = along(rows[d], response);
  }
}

} // namespace steplap
