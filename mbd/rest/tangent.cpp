#include "mbd/rest/tangent.h"

#include "mbd/base/decompositions.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

// Rows whose independent part, relative to their length, is below this are dependent. The first value is for joints, the second for
// friction, as in the equations of motion (theory.md).
constexpr double k_rank = 1e-9, k_friction_rank = 1e-6;
constexpr double k_least_radius = 1e-3; // fraction of the size of the model
// Share of the radius of gyration; bodies closer to each other do not determine the size of the model.
constexpr double k_least_extent = 0.1;

// Returns the indices of independent columns of `rows`: first those of joints (the first `joints` columns), then those of friction. Columns
// have unit length.
std::vector<int> independent(const MatX& rows, Eigen::Index joints) {
  std::vector<int> kept;
  const Eigen::Index n = rows.rows(), frictions = rows.cols() - joints;
  MatX held(n, 0);
  if (joints > 0) {
    const PivotedQr qr(rows.leftCols(joints), k_rank);
    for (Eigen::Index i = 0; i < qr.rank(); ++i) kept.push_back(qr.column(i));
    if (frictions > 0) held = qr.q(qr.rank());
  }
  if (frictions == 0) return kept;
  const MatX beyond = rows.rightCols(frictions) - held * (held.transpose() * rows.rightCols(frictions));
  const PivotedQr qr(beyond);
  const Eigen::Index most = std::min(frictions, n);
  for (Eigen::Index i = 0; i < most && qr.length(i) > k_friction_rank; ++i) kept.push_back(static_cast<int>(joints + qr.column(i)));
  return kept;
}

} // namespace

SceneScale scale_of(const System& system, const State& state) {
  double low[2] = {0, 0}, high[2] = {0, 0}, lever = 0.0, gyration = 0.0;
  std::vector<double> radius(system.bodies.size(), 0.0);
  for (int i = 1; i < system.body_count(); ++i) {
    for (int c = 0; c < 2; ++c) {
      const double x = state.q[3 * i + c];
      low[c] = i == 1 ? x : std::min(low[c], x);
      high[c] = i == 1 ? x : std::max(high[c], x);
    }
    radius[i] = std::sqrt(system.bodies[i].inertia / system.bodies[i].mass);
    gyration = std::max(gyration, radius[i]);
  }
  for (const RowSpec& row : system.rows)
    for (const auto& [body, point] : {std::pair{row.a, row.point_a}, std::pair{row.b, row.point_b}}) {
      if (body == k_ground) continue;
      lever = std::max(lever, point.norm());
      radius[body] = std::max(radius[body], point.norm());
    }
  SceneScale scene;
  scene.length = std::max({high[0] - low[0], high[1] - low[1], lever});
  if (scene.length <= k_least_extent * gyration) scene.length = gyration;
  if (!(scene.length > 0.0)) scene.length = 1.0;
  scene.reach = scene.length;
  scene.scale = VecX::Ones(3 * (system.body_count() - 1));
  for (int i = 1; i < system.body_count(); ++i) {
    scene.scale[3 * i - 1] = 1.0 / std::clamp(radius[i], k_least_radius * scene.length, scene.length);
    for (int c = 0; c < 2; ++c) scene.reach = std::max(scene.reach, std::abs(state.q[3 * i + c]));
  }
  return scene;
}

Tangent tangent_of(const Statics& statics, const VecX& scale, const std::vector<int>* kept_before) {
  Tangent t;
  const Eigen::Index n = statics.coordinates();
  MatX rows = (statics.gradient() * scale.asDiagonal()).transpose(); // n × m
  t.row_size = rows.colwise().norm().cwiseMax(1e-300);
  rows = rows * t.row_size.cwiseInverse().asDiagonal();
  t.kept = kept_before ? *kept_before : independent(rows, statics.bilateral_count());
  const auto count = static_cast<Eigen::Index>(t.kept.size());
  if (count == 0) {
    t.held = MatX(n, 0);
    t.free = MatX::Identity(n, n);
    return t;
  }
  MatX kept(n, count);
  for (Eigen::Index i = 0; i < count; ++i) kept.col(i) = rows.col(t.kept[i]);
  const auto [q, r] = qr_of(kept, kept_before ? count : n);
  t.held = q.leftCols(count);
  if (!kept_before) t.free = q.rightCols(n - count);
  t.triangle = r;
  return t;
}

VecX multipliers_of(const Statics& statics, const VecX& scale, const Tangent& t) {
  VecX lambda = VecX::Zero(static_cast<Eigen::Index>(statics.rows().size()));
  if (t.kept.empty()) return lambda;
  const VecX force = scale.cwiseProduct(statics.force());
  const VecX along = t.triangle.triangularView<Eigen::Upper>().solve(VecX(-(t.held.transpose() * force)));
  for (std::size_t i = 0; i < t.kept.size(); ++i) lambda[t.kept[i]] = along[static_cast<Eigen::Index>(i)] / t.row_size[t.kept[i]];
  return lambda;
}

} // namespace steplap
