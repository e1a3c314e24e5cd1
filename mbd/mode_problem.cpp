// The matrices of the problem that decides which friction sticks: how the candidates' rows answer forces
// along one another, everything else as it is in the present modes.
#include "mbd/dynamics.h"

#include <algorithm>

namespace steplap {

void Dynamics::respond(Candidates& candidates, const double* dy) {
  Layout& layout = *layout_;
  const std::size_t n = candidates.rows.size();
  const int coordinates = coordinate_count();
  candidates.compliance.assign(n * n, 0.0);
  candidates.acceleration.assign(n, 0.0);
  for (int i = 1; i < system_.body_count(); ++i) place_member(i);
  std::vector<SchurRow> rows(n);
  std::vector<double> response(coordinates), lambda(layout.active.size());
  for (std::size_t c = 0; c < n; ++c) {
    const RowSpec& spec = *candidates.rows[c];
    const auto m = evaluate_row<true>(spec, motion_.data());
    rows[c].body[0] = layout.placements[spec.a].cluster;
    rows[c].body[1] = layout.placements[spec.b].cluster;
    for (int side = 0; side < 2; ++side)
      if (rows[c].body[side] >= 0) std::copy_n(layout.clusters[rows[c].body[side]].w, 3, rows[c].w[side]);
    to_clusters(spec, m, rows[c]);
    candidates.acceleration[c] = cluster_bias(spec, m);
    for (int side = 0; side < 2; ++side)
      if (rows[c].body[side] >= 0)
        for (int k = 0; k < 3; ++k)
          candidates.acceleration[c] += rows[c].j[side][k] * dy[coordinates + 3 * rows[c].body[side] + k];
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
