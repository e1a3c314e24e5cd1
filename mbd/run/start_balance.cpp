#include "mbd/run/start_balance.h"

#include "mbd/base/decompositions.h"
#include "mbd/system/gap_source.h"
#include "mbd/system/row_gradient.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Number of coordinates above which joint constraints are ignored: dense algebra of this size takes a tenth of a second.
constexpr int k_most_dense = 300;

} // namespace

StartBalance::StartBalance(const System& system, const State& state) : state_(state), statics_(system) {
  std::fill(state_.v.begin(), state_.v.end(), 0.0);
  for (FrictionState& friction : state_.friction)
    if (friction.phase != FrictionPhase::apart) friction.phase = FrictionPhase::free;
  statics_.evaluate(state_);
  statics_.collect_rows(state_);
  scale_ = scale_of(system, state_).scale;
  mass_ = VecX(statics_.coordinates());
  for (int k = 0; k < statics_.coordinates(); ++k) {
    const BodyData& body = system.bodies[static_cast<std::size_t>(k / 3 + 1)];
    mass_[k] = k % 3 < 2 ? body.mass : body.inertia * scale_[k] * scale_[k];
  }
  if (system.contact_count > 0)
    for (const auto& group : system.groups) group->add_jacobian(statics_.evaluation(), parts_);
  if (!statics_.rows().empty() && statics_.coordinates() <= k_most_dense) {
    const OneThread alone;
    free_ = tangent_of(statics_, scale_).free;
    const MatX reduced = free_.transpose() * mass_.asDiagonal() * free_;
    if (reduced.size() > 0) inverse_ = solve_symmetric(reduced, MatX(MatX::Identity(reduced.rows(), reduced.cols())));
  }
  all_ = acceleration(statics_.force());
  loads_ = acceleration(statics_.force() - contact_forces(system));
}

VecX StartBalance::acceleration(const VecX& force) const {
  const VecX scaled = scale_.cwiseProduct(force);
  if (free_.rows() == 0) return scale_.cwiseProduct(scaled.cwiseQuotient(mass_));
  if (free_.cols() == 0) return VecX::Zero(force.size());
  return scale_.cwiseProduct(free_ * (inverse_ * (free_.transpose() * scaled)));
}

VecX StartBalance::contact_forces(const System& system) const {
  Evaluation e = statics_.evaluation();
  std::vector<BodyForce> force(system.bodies.size() + static_cast<std::size_t>(system.links.size()));
  e.force = e.link_force = force.data();
  for (const auto& group : system.groups)
    if (group->gap_source()) group->add_forces(e);
  for (int i = 0; i < system.links.size(); ++i) {
    const Link& link = system.links[i];
    const int slot = system.links.slot(i);
    add_link_force(force[slot], statics_.motion()[slot], statics_.motion()[link.b], force[link.a], force[link.b]);
  }
  VecX sum(statics_.coordinates());
  for (int i = 1; i < system.body_count(); ++i) sum.segment<3>(3 * i - 3) = Vec3(force[i].fx, force[i].fy, force[i].m);
  return sum;
}

StartBalance::Opening StartBalance::opening(const VecX& gradient, double own) const {
  double by_loads = gradient.dot(loads_);
  if (own != 0.0) by_loads -= own * gradient.dot(acceleration(gradient));
  return {gradient.dot(all_), std::abs(by_loads)};
}

VecX StartBalance::gap_gradient(int contact) const {
  for (const PairJacobian& part : parts_) {
    if (part.contact != contact) continue;
    const double stiffness = part.normal.segment<2>(part.a != k_ground ? 0 : 3).norm();
    if (!(stiffness > 0.0)) return {};
    VecX gradient = VecX::Zero(statics_.coordinates());
    for (int i = 0; i < 6; ++i)
      if (const int body = i < 3 ? part.a : part.b; body != k_ground) gradient[3 * body - 3 + i % 3] = -part.normal[i] / stiffness;
    return gradient;
  }
  return {};
}

VecX StartBalance::gradient(const RowSpec& row) const {
  const RowGradient<double> by = gradient_of(evaluate_row<false>(row, statics_.motion().data()));
  VecX gradient = VecX::Zero(statics_.coordinates());
  for (int i = 0; i < 6; ++i)
    if (const int body = i < 3 ? row.a : row.b; body != k_ground) gradient[3 * body - 3 + i % 3] = by.j[i];
  return gradient;
}

} // namespace steplap
