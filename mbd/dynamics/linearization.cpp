#include "mbd/dynamics/linearization.h"

#include "mbd/base/decompositions.h"
#include "mbd/base/dual.h"
#include "mbd/dynamics/kinematics.h"
#include "mbd/dynamics/row_pull.h"
#include "mbd/system/law_group.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using D12 = Dual<12>;

// Step of the central differences of slip laws, relative to the quantity that is changed: the cube root of the rounding error.
constexpr double k_relative_step = 6e-6;
constexpr double k_pose_step = 1e-7;  // step for positions, m, and angles, rad; suits bodies of about one metre
constexpr double k_least_rate = 1e-9; // smallest magnitude assumed for rates, m/s or rad/s

// Returns the motion of a body in a cluster with motion k.
Motion<D12> placed(const Motion<D12>& k, const Placement& place) {
  if (place.is_trivial) return k;
  Motion<D12> m;
  place_in_cluster(place, k, m);
  return m;
}

// A row as a function of the poses (derivative indices 0–5) and velocities (6–11) of the clusters on its two sides.
struct DualRow {
  int cluster[2];
  D12 rate, bias;
  D12 j[6]; ///< gradient by the coordinates on either side
};

template <bool WithBias> DualRow differentiate(const RowSpec& spec, const Layout& layout, const std::vector<Motion<double>>& motion) {
  const int body[2] = {spec.a, spec.b};
  DualRow row;
  Motion<D12> cluster[2], member[2];
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout.placements[body[side]];
    row.cluster[side] = place.cluster;
    if (place.cluster < 0) continue; // the ground is at rest at the origin
    cluster[side] = seeded(motion[layout.clusters[place.cluster].motion], 3 * side);
    member[side] = placed(cluster[side], place);
  }
  const MeasureValue<D12> m = evaluate_row<WithBias>(spec, member[0], member[1]);
  row.rate = m.rate;
  row.bias = m.bias;
  for (int side = 0; side < 2; ++side) {
    if (row.cluster[side] < 0) continue;
    const Pair<D12> off{member[side].x - cluster[side].x, member[side].y - cluster[side].y};
    put_gradient(m, side, (side == 0 ? m.lever_a : m.lever_b) + off, &row.j[3 * side]);
    if constexpr (WithBias) add_centripetal(side, m.direction, cluster[side].omega, off, row.bias);
  }
  return row;
}

} // namespace

void Linearization::put(std::vector<Triplet>& entries, int row, int column, double value) {
  if (column >= 3 * layout_->absolute_count || (*inverse_mass_)[column] > 0.0) entries.emplace_back(row, column, value);
}

void Linearization::evaluate(Dynamics& dynamics, double t, const double* y, const PartsHook& change) {
  dynamics_ = &dynamics;
  layout_ = &dynamics.layout();
  n_ = dynamics.coordinate_count();
  m_ = static_cast<int>(layout_->active.size());
  inverse_mass_ = &layout_->inverse_mass;
  dy_.resize(dynamics.dimension());
  dynamics.rates(t, y, dy_.data());
  acceleration_ = dynamics.cluster_accelerations(dy_.data());
  for (auto* entries : {&stiffness_, &damping_, &gradient_, &bias_q_, &bias_v_, &response_}) entries->clear();
  parts_.clear();
  first_part_.clear();
  for (const auto& group : dynamics.system().groups) {
    first_part_.push_back(parts_.size());
    group->add_jacobian(dynamics.evaluation(), parts_);
  }
  if (change) change(dynamics.evaluation(), parts_, first_part_);
  for (const PairJacobian& part : parts_) add_forces(part);
  inner_parts_.clear();
  inner_.clear();
  for (const ForceGroup* group : dynamics.system().inner_groups) group->add_inner_jacobian(dynamics.evaluation(), inner_parts_);
  for (const InnerJacobian& part : inner_parts_) add_inner(part);
  if (dynamics.inner_count() > 0) add_states();
  for (std::size_t r = 0; r < layout_->active.size(); ++r) add_row(r);
  if (!layout_->sliding.empty()) motion_.assign(dynamics_->motion().begin(), dynamics_->motion().end());
  for (const int f : layout_->sliding) add_sliding(f);
  add_transport();
  if (layout_->has_mechanisms()) reduce();
}

// Adds the derivatives of the force on one body by the motion of another one, converted to the coordinates of their clusters.
void Linearization::add_body_block(int row_body, int column_body, const Mat3& by_pose, const Mat3& by_velocity) {
  const Placement& row = layout_->placements[row_body];
  const Placement& column = layout_->placements[column_body];
  if (row.cluster < 0 || column.cluster < 0) return;
  Mat3 k = by_pose, d = by_velocity;
  const std::vector<Motion<double>>& motion = dynamics_->motion();
  if (!column.is_trivial) {
    const Motion<double>& centre = motion[layout_->clusters[column.cluster].motion];
    const double x = motion[column_body].x - centre.x, y = motion[column_body].y - centre.y;
    // v_body = v + ω ẑ×lever, and the lever rotates with θ.
    k.col(2) += -y * by_pose.col(0) + x * by_pose.col(1) - centre.omega * (x * by_velocity.col(0) + y * by_velocity.col(1));
    d.col(2) += -y * by_velocity.col(0) + x * by_velocity.col(1);
  }
  if (!row.is_trivial) {
    const Motion<double>& centre = motion[layout_->clusters[row.cluster].motion];
    const double x = motion[row_body].x - centre.x, y = motion[row_body].y - centre.y;
    k.row(2) += x * k.row(1) - y * k.row(0);
    d.row(2) += x * d.row(1) - y * d.row(0);
  }
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      put(stiffness_, 3 * row.cluster + i, 3 * column.cluster + j, k(i, j));
      put(damping_, 3 * row.cluster + i, 3 * column.cluster + j, d(i, j));
    }
}

void Linearization::add_forces(const PairJacobian& part) {
  const int body[2] = {part.a, part.b};
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      add_body_block(body[i], body[j], part.stiffness.block<3, 3>(3 * i, 3 * j), part.damping.block<3, 3>(3 * i, 3 * j));
}

void Linearization::add_inner(const InnerJacobian& part) {
  InnerBlock& block = inner_.emplace_back();
  block.first = part.first;
  block.count = part.count;
  block.by_inner = part.by_inner;
  block.force.setZero();
  block.by_pose.setZero();
  block.by_velocity.setZero();
  const int body[2] = {part.a, part.b};
  for (int side = 0; side < 2; ++side) {
    const Placement& place = layout_->placements[body[side]];
    if (place.cluster < 0) continue;
    block.cluster[side] = place.cluster;
    Mat3 f = part.force.middleRows<3>(3 * side), p = part.by_pose.middleCols<3>(3 * side), v = part.by_velocity.middleCols<3>(3 * side);
    if (!place.is_trivial) { // as in add_body_block
      const Motion<double>&m = dynamics_->motion()[body[side]], &centre = dynamics_->motion()[layout_->clusters[place.cluster].motion];
      const double x = m.x - centre.x, y = m.y - centre.y;
      f.row(2) += x * f.row(1) - y * f.row(0);
      p.col(2) += -y * p.col(0) + x * p.col(1) - centre.omega * (x * v.col(0) + y * v.col(1));
      v.col(2) += -y * v.col(0) + x * v.col(1);
    }
    for (int c = 0; c < 3; ++c)
      if (!((*inverse_mass_)[3 * place.cluster + c] > 0.0)) p.col(c).setZero(), v.col(c).setZero();
    block.force.middleRows<3>(3 * side) = f;
    block.by_pose.middleCols<3>(3 * side) = p;
    block.by_velocity.middleCols<3>(3 * side) = v;
  }
}

void Linearization::add_states() {
  state_jacobian_.clear();
  for (auto* const entries : {&states_.by_pose, &states_.by_velocity, &states_.by_state, &states_.forces}) entries->clear();
  for (const auto& group : dynamics_->system().groups) group->add_state_jacobian(dynamics_->evaluation(), state_jacobian_);
  const std::vector<Motion<double>>& motion = dynamics_->motion();
  for (const StateJacobian::ByMotion& part : state_jacobian_.by_motion) { // as in add_body_block
    const Placement& place = layout_->placements[part.body];
    if (place.cluster < 0) continue;
    Vec3 p = part.pose, v = part.velocity;
    if (!place.is_trivial) {
      const Motion<double>& centre = motion[layout_->clusters[place.cluster].motion];
      const double x = motion[part.body].x - centre.x, y = motion[part.body].y - centre.y;
      p[2] += -y * part.pose[0] + x * part.pose[1] - centre.omega * (x * part.velocity[0] + y * part.velocity[1]);
      v[2] += -y * part.velocity[0] + x * part.velocity[1];
    }
    for (int c = 0; c < 3; ++c) {
      put(states_.by_pose, part.inner, 3 * place.cluster + c, p[c]);
      put(states_.by_velocity, part.inner, 3 * place.cluster + c, v[c]);
    }
  }
  for (const StateJacobian::ByState& part : state_jacobian_.by_state) states_.by_state.emplace_back(part.inner, part.by, part.value);
  for (const StateJacobian::Force& part : state_jacobian_.forces) {
    const Placement& place = layout_->placements[part.body];
    if (place.cluster < 0) continue;
    Vec3 f = part.value;
    if (!place.is_trivial) {
      const Motion<double>& centre = motion[layout_->clusters[place.cluster].motion];
      f[2] += (motion[part.body].x - centre.x) * f[1] - (motion[part.body].y - centre.y) * f[0];
    }
    for (int c = 0; c < 3; ++c) states_.forces.emplace_back(3 * place.cluster + c, part.inner, f[c]);
  }
}

// Adds the derivative of a moment: the force F on a body at distance l from its cluster's centre has the moment l × F, and ∂(l × F)/∂θ =
// −l·F.
void Linearization::add_transport() {
  const std::vector<Motion<double>>& motion = dynamics_->motion();
  for (const int i : layout_->riding) {
    const Placement& place = layout_->placements[i];
    const Motion<double>& centre = motion[layout_->clusters[place.cluster].motion];
    const BodyForce& f = dynamics_->evaluation().force[i];
    // `force` contains sliding wrenches, too; take_out_transport() removes their part.
    const int k = 3 * place.cluster + 2;
    put(stiffness_, k, k, -((motion[i].x - centre.x) * f.fx + (motion[i].y - centre.y) * f.fy));
  }
}

// Adds the terms of a row, part by part; all terms are linear in the row.
void Linearization::add_row(std::size_t r) {
  for (const RowSpec* part = layout_->active[r].spec; part; part = part->next) add_part(r, *part);
}

void Linearization::add_part(std::size_t r, const RowSpec& spec) {
  const DualRow row = differentiate<true>(spec, *layout_, dynamics_->motion());
  const double lambda = dynamics_->multipliers()[r];
  const int i = static_cast<int>(r);
  D12 slack = -row.bias; // γ − J a, without the prescribed acceleration, which does not depend on the state
  for (int k = 0; k < 6; ++k)
    if (const int c = row.cluster[k / 3]; c >= 0) slack -= row.j[k] * D12(acceleration_[3 * c + k % 3]);
  for (int k = 0; k < 6; ++k) {
    if (row.cluster[k / 3] < 0) continue;
    const int at = 3 * row.cluster[k / 3] + k % 3;
    gradient_.emplace_back(i, at, row.j[k].v);
    for (int l = 0; l < 6; ++l) {
      if (row.cluster[l / 3] < 0) continue;
      put(stiffness_, at, 3 * row.cluster[l / 3] + l % 3, lambda * row.j[k].d[l]);
    }
  }
  for (int l = 0; l < 6; ++l) {
    if (row.cluster[l / 3] < 0) continue;
    const int at = 3 * row.cluster[l / 3] + l % 3;
    put(bias_q_, i, at, slack.d[l]);
    put(bias_v_, i, at, slack.d[6 + l]);
  }
}

MatX Linearization::dense(const std::vector<Triplet>& entries, int rows) const {
  MatX result = MatX::Zero(rows, n_);
  for (const Triplet& e : entries) result(e.row(), e.col()) += e.value();
  return result;
}

void Linearization::acceleration_by_state(MatX& by_pose, MatX& by_velocity) const {
  const VecX w = VecX::Map(inverse_mass_->data(), n_);
  by_pose = w.asDiagonal() * dense(stiffness_, n_);
  by_velocity = w.asDiagonal() * dense(damping_, n_);
  if (m_ == 0) return;
  const MatX j = dense(gradient_, m_);
  MatX wj = w.asDiagonal() * j.transpose();
  if (!response_.empty()) {
    wj.setZero();
    for (const Triplet& e : response_) wj(e.row(), e.col()) += e.value();
  }
  const RankLu schur(j * wj); // rank-revealing, since rows may depend on each other
  by_pose += wj * schur.solve(dense(bias_q_, m_) - j * by_pose);
  by_velocity += wj * schur.solve(dense(bias_v_, m_) - j * by_velocity);
}

// One sliding friction element. Its forces w_r J_rᵀ, with w = w(relative velocity, relative pose, normal forces), are differentiated by
// central differences.
struct Linearization::Sliding {
  const FrictionElement& friction;
  const FrictionState& state;
  const RowSpec* specs;
  int count;        ///< number of rows, 1 or 3
  Evaluation moved; ///< input of the slip law, changed one number at a time
  DualRow rows[3] = {};
  double rate[3] = {0, 0, 0}, wrench[3] = {0, 0, 0};
  double by_state[3][12] = {}; ///< derivatives of the wrench by the clusters' coordinates; columns as derivative indices of DualRow

  void difference(double& x, double step, double* slope) {
    const double before = x;
    double ahead[3], behind[3];
    x = before + step;
    friction.slip_wrench(moved, state, rate, ahead);
    x = before - step;
    friction.slip_wrench(moved, state, rate, behind);
    x = before;
    for (int r = 0; r < count; ++r) slope[r] = (ahead[r] - behind[r]) / (2.0 * step);
  }
  /// Returns the derivative of the generalised force on coordinate k, Σ_r J_rk ∂w_r/∂x.
  [[nodiscard]] double along(int k, const double* slope) const {
    double sum = 0.0;
    for (int r = 0; r < count; ++r) sum += rows[r].j[k].v * slope[r];
    return sum;
  }
};

void Linearization::add_sliding(int f) {
  const FrictionElement& friction = *dynamics_->system().frictions[f].friction;
  const FrictionState& state = dynamics_->evaluation().friction[f];
  Sliding sliding{friction, state, friction.rows(state), friction.dimension(), dynamics_->evaluation()};
  for (int r = 0; r < sliding.count; ++r) {
    sliding.rows[r] = differentiate<false>(sliding.specs[r], *layout_, dynamics_->motion());
    sliding.rate[r] = sliding.rows[r].rate.v;
  }
  friction.slip_wrench(dynamics_->evaluation(), state, sliding.rate, sliding.wrench);
  differentiate_by_rate(sliding);
  if (sliding.count == 3) differentiate_by_pose(sliding);
  else differentiate_by_value(sliding);
  add_sliding_rows(sliding);
  take_out_transport(sliding);
  add_normal_forces(sliding);
}

void Linearization::differentiate_by_rate(Sliding& sliding) const {
  double size = k_least_rate;
  for (int r = 0; r < sliding.count; ++r) size = std::max(size, std::abs(sliding.rate[r]));
  for (int c = 0; c < sliding.count; ++c) {
    double slope[3];
    sliding.difference(sliding.rate[c], k_relative_step * size, slope);
    for (int r = 0; r < sliding.count; ++r)
      for (int l = 0; l < 12; ++l) sliding.by_state[r][l] += slope[r] * sliding.rows[c].rate.d[l];
  }
}

// Differentiates the wrench of an element with three rows by their values (x, y along b's axes, angle), which are the relative pose and
// have exact gradients. They are changed one at a time, by moving a.
void Linearization::differentiate_by_pose(Sliding& sliding) {
  const RowSpec* const specs = sliding.specs;
  sliding.moved.motion = motion_.data();
  Motion<double>& a = motion_[specs[0].a];
  const Motion<double>& b = motion_[specs[0].b];
  for (int c = 0; c < 3; ++c) {
    const Motion<double> start = a;
    double ends[2][3];
    for (int end = 0; end < 2; ++end) {
      const double step = end == 0 ? k_pose_step : -k_pose_step;
      a = start;
      if (c == 2) {
        set_angle(a, start.theta + step);
        const Pair<double> before = to_ground(start, specs[0].point_a), after = to_ground(a, specs[0].point_a);
        a.x += before.x - after.x;
        a.y += before.y - after.y;
      } else {
        const Pair<double> e = to_ground(b, specs[c].direction);
        a.x += step * e.x;
        a.y += step * e.y;
      }
      sliding.friction.slip_wrench(sliding.moved, sliding.state, sliding.rate, ends[end]);
    }
    a = start;
    for (int r = 0; r < 3; ++r)
      for (int k = 0; k < 6; ++k) sliding.by_state[r][k] += (ends[0][r] - ends[1][r]) / (2.0 * k_pose_step) * sliding.rows[c].j[k].v;
  }
  sliding.moved.motion = dynamics_->evaluation().motion;
}

// Differentiates the wrench of an element with one row by the row's value, on which it may depend, as that of a buffer on its compression.
// The value is changed by moving a along the gradient.
void Linearization::differentiate_by_value(Sliding& sliding) {
  const RowSpec& spec = *sliding.specs;
  sliding.moved.motion = motion_.data();
  Motion<double>& a = motion_[spec.a];
  const Motion<double> start = a;
  const RowGradient<double> gradient = row_gradient(spec, start, motion_[spec.b]);
  const double* const j = gradient.side(0);
  const double square = j[0] * j[0] + j[1] * j[1] + j[2] * j[2];
  double ends[2];
  for (int end = 0; end < 2; ++end) {
    const double step = (end == 0 ? k_pose_step : -k_pose_step) / square;
    a.x = start.x + step * j[0];
    a.y = start.y + step * j[1];
    set_angle(a, start.theta + step * j[2]);
    sliding.friction.slip_wrench(sliding.moved, sliding.state, sliding.rate, &ends[end]);
  }
  a = start;
  const double slope = (ends[0] - ends[1]) / (2.0 * k_pose_step);
  for (int k = 0; k < 6; ++k) sliding.by_state[0][k] += slope * sliding.rows[0].j[k].v;
  sliding.moved.motion = dynamics_->evaluation().motion;
}

// Adds the derivatives by a coordinate of a cluster, and by its rate, to the equation of coordinate k of the rows.
void Linearization::put_along(const Sliding& sliding, int k, int cluster, int coordinate, double by_pose, double by_velocity) {
  const int own = sliding.rows[0].cluster[k / 3];
  if (own < 0 || cluster < 0) return;
  const int row = 3 * own + k % 3, column = 3 * cluster + coordinate;
  put(stiffness_, row, column, by_pose);
  put(damping_, row, column, by_velocity);
}

// Adds the derivatives due to the rotation of the rows, and those due to the change of the wrench.
void Linearization::add_sliding_rows(const Sliding& sliding) {
  const DualRow* const rows = sliding.rows;
  for (int k = 0; k < 6; ++k)
    for (int l = 0; l < 6; ++l) {
      double by_pose = 0.0, by_velocity = 0.0;
      for (int r = 0; r < sliding.count; ++r) {
        by_pose += sliding.wrench[r] * rows[r].j[k].d[l] + rows[r].j[k].v * sliding.by_state[r][l];
        by_velocity += rows[r].j[k].v * sliding.by_state[r][6 + l];
      }
      put_along(sliding, k, rows[0].cluster[l / 3], l % 3, by_pose, by_velocity);
    }
}

// Subtracts the part that add_transport() has added for this wrench on bodies off their clusters' centres, because the gradients of the
// rows contain the whole term.
void Linearization::take_out_transport(const Sliding& sliding) {
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? sliding.specs[0].a : sliding.specs[0].b;
    const Placement& place = layout_->placements[body];
    if (place.cluster < 0 || place.is_trivial) continue;
    const Motion<double>&m = dynamics_->motion()[body], &centre = dynamics_->motion()[layout_->clusters[place.cluster].motion];
    double along_lever = 0.0;
    for (int r = 0; r < sliding.count; ++r) {
      const DualRow& row = sliding.rows[r];
      along_lever += sliding.wrench[r] * ((m.x - centre.x) * row.j[3 * side].v + (m.y - centre.y) * row.j[3 * side + 1].v);
    }
    put(stiffness_, 3 * place.cluster + 2, 3 * place.cluster + 2, along_lever);
  }
}

// Adds the derivatives by normal forces, for all contacts on which the wrench depends.
void Linearization::add_normal_forces(Sliding& sliding) {
  normal_.assign(sliding.moved.contact_force, sliding.moved.contact_force + dynamics_->system().contact_count);
  sliding.moved.contact_force = normal_.data();
  for (const PairJacobian& part : parts_) {
    if (part.contact < 0) continue;
    double slope[3];
    sliding.difference(normal_[part.contact], k_relative_step * (1.0 + normal_[part.contact]), slope);
    for (int k = 0; k < 6; ++k)
      if (const double along = sliding.along(k, slope); along != 0.0) add_normal_force(sliding, part, k, along);
  }
}

// Adds the derivatives by one normal force: `along` times its derivatives by the coordinates of its bodies, converted to those of their
// clusters.
void Linearization::add_normal_force(const Sliding& sliding, const PairJacobian& contact, int k, double along) {
  for (int side = 0; side < 2; ++side) {
    const int body = side == 0 ? contact.a : contact.b;
    const Placement& place = layout_->placements[body];
    if (place.cluster < 0) continue;
    Vec3 by_q = contact.normal.segment<3>(3 * side), by_v = contact.normal.segment<3>(6 + 3 * side);
    if (!place.is_trivial) {
      const Motion<double>& centre = dynamics_->motion()[layout_->clusters[place.cluster].motion];
      const double x = dynamics_->motion()[body].x - centre.x, y = dynamics_->motion()[body].y - centre.y;
      by_q[2] += -y * by_q[0] + x * by_q[1] - centre.omega * (x * by_v[0] + y * by_v[1]);
      by_v[2] += -y * by_v[0] + x * by_v[1];
    }
    for (int c = 0; c < 3; ++c) put_along(sliding, k, place.cluster, c, along * by_q[c], along * by_v[c]);
  }
}

} // namespace steplap
