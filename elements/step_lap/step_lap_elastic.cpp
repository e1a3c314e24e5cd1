#include "elements/step_lap/step_lap_elastic.h"

#include "mbd/system/law_group.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

using D12 = Dual<12>;

constexpr int k_direction = 3, k_lost = 6; // indices, relative to ElementData::inner: direction of slip (3), 1 once the joint came apart
constexpr int k_most_returns = 5;          // largest number of iterations; each squares the relative change of the overlap
constexpr double k_on_surface = 1e-15;     // tolerance of u on the limit surface
// Limits of the iteration for p at a given direction of slip. The first step leaves a relative error of strain over width of the overlap.
constexpr int k_most_followed = 20;
constexpr double k_followed = 1e-14; // tolerance relative to the strain
// Length, m, by which the direction is scaled as a state. Displacements near zero have an error of a thousandth of the tolerance
// (Integrator::update_weights), so the direction has an error of the tolerance.
constexpr double k_direction_length = 1e-3;
// Limits of the roundness of the limit surface (StepLapFriction) below which the slip direction becomes a state, and above which it ceases
// to be one. The wrench determines the direction to tolerance/roundness; where that is sufficient it is the smoother choice.
constexpr double k_sharp = 1e-3, k_blunt = 1e-2;
constexpr double k_strain_step = 1e-5; // step of finite differences of the flow, relative to the strain
constexpr double k_least_step = 1e-12; // smallest step of finite differences, m

Pose slid_at(const double* inner) { return {inner[0], inner[1], inner[2]}; }

bool is_apart(UnitMode mode) { return elastic_state(mode) == k_elastic_apart; }
bool is_yielding(UnitMode mode) { return elastic_state(mode) == k_elastic_yields; }
bool is_following(UnitMode mode) { return elastic_state(mode) == k_elastic_follows; }

/// Returns the strain s − p.
Vec3 strain(const Pose& now, const double* slid) { return {now.x - slid[0], now.y - slid[1], now.theta - slid[2]}; }

double stored(const ElasticGripGroup::ElementData& entry, const Motion<double>* motion, const double* inner) {
  if (inner[entry.inner + k_lost] != 0.0) return 0.0;
  const Vec3 d = strain(entry.friction->pose_of(motion), inner + entry.inner);
  return 0.5 * d.dot(entry.friction->stiffness() * d);
}

Vec3 direction(const double* slid) { return Vec3::Map(slid + k_direction) / k_direction_length; }

/// The three measures of the joint with their derivatives by the motions of both bodies.
struct Measures {
  MeasureValue<D12> m[3];
  Measures(const ElasticGripGroup::ElementData& entry, const Evaluation& e) {
    const Motion<D12> a = seeded(e.motion[entry.a], 0), b = seeded(e.motion[entry.b], 3);
    const RowSpec* hold = entry.friction->hold;
    for (int r = 0; r < 2; ++r) m[r] = AxisMeasure{hold[r].point_a, hold[r].point_b, hold[r].direction}.at<false, D12>(a, b);
    m[2] = AngleMeasure{}.at<false, D12>(a, b);
  }
  /// Computes the force on a, then that on b, for a unit wrench along measure r.
  void gradient(int r, D12* j) const {
    const D12 rows[6] = {m[r].direction.x,  m[r].direction.y,  cross(m[r].lever_a, m[r].direction) + m[r].couple,
                         -m[r].direction.x, -m[r].direction.y, -(cross(m[r].lever_b, m[r].direction) + m[r].couple)};
    std::copy(rows, rows + 6, j);
  }
  /// Returns the derivatives of all three measures with respect to the poses, equal to those of their rates with respect to the velocities.
  [[nodiscard]] Eigen::Matrix<double, 3, 6> gradient() const {
    Eigen::Matrix<double, 3, 6> by_pose;
    for (int r = 0; r < 3; ++r) {
      D12 along[6];
      gradient(r, along);
      for (int i = 0; i < 6; ++i) by_pose(r, i) = along[i].v;
    }
    return by_pose;
  }
  [[nodiscard]] Vec3 values() const { return {m[0].value.v, m[1].value.v, m[2].value.v}; }
  [[nodiscard]] Vec3 rates() const { return {m[0].rate.v, m[1].rate.v, m[2].rate.v}; }
  [[nodiscard]] Eigen::Matrix<double, 3, 6> rates_by_pose() const {
    Eigen::Matrix<double, 3, 6> turning;
    for (int r = 0; r < 3; ++r) turning.row(r) = m[r].rate.d.template head<6>().matrix().transpose();
    return turning;
  }
};

/// Returns the direction of slip that the wrench determines.
Vec3 told_direction(const ElasticGripGroup::ElementData& entry, const Evaluation& e, const double* p) {
  return entry.friction->direction_of(e, slid_at(p), entry.friction->stiffness() * strain(entry.friction->pose_of(e.motion), p));
}

/// Returns the mode at the start of yielding: the direction is a state at a corner of the limit surface; elsewhere it follows from the
/// wrench.
UnitMode sliding_mode(const ElasticGripGroup::ElementData& entry, const Evaluation& e, const double* p) {
  return entry.friction->roundness(e, slid_at(p), told_direction(entry, e, p)) < k_sharp ? k_elastic_follows : k_elastic_yields;
}

/// Moves p along the strain until the wrench lies on the limit surface (u = 1). Returns the dissipated energy, J.
double return_to_surface(const ElasticGripGroup::ElementData& entry, const Evaluation& e, double* p) {
  const Pose now = entry.friction->pose_of(e.motion);
  double dissipated = 0.0;
  for (int i = 0; i < k_most_returns; ++i) {
    const Vec3 d = strain(now, p), force = entry.friction->stiffness() * d;
    const double u = entry.friction->yield_usage(e, slid_at(p), force);
    if (!std::isfinite(u) || u <= 0.0 || std::abs(u - 1.0) <= k_on_surface) break;
    const Vec3 moved = d - d / u;
    Vec3::Map(p) += moved;
    dissipated += (force * (0.5 + 0.5 / u)).dot(moved); // equals the decrease of the stored elastic energy
  }
  return dissipated;
}

/// Moves p until the wrench is that of the direction of slip. Used at a corner of the limit surface, where the wrench hardly determines the
/// direction, but the direction always determines the wrench. Returns the dissipated energy, J.
double follow_direction(const ElasticGripGroup::ElementData& entry, const Evaluation& e, double* p) {
  if (direction(p).isZero(0.0) || entry.friction->grip_beyond_last(e, slid_at(p)) <= 0.0) return 0.0; // the joint has already separated
  const Vec3 along = direction(p).normalized();
  Vec3::Map(p + k_direction) = k_direction_length * along;
  const Pose now = entry.friction->pose_of(e.motion);
  double dissipated = 0.0;
  const Mat3 compliance = entry.friction->stiffness().inverse();
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < k_most_followed; ++i) {
    const Vec3 d = strain(now, p), force = entry.friction->stiffness() * d;
    const Vec3 over = force - entry.friction->bound_along(e, slid_at(p), along), moved = compliance * over;
    const double left = over.dot(moved);
    if (!(left > k_followed * k_followed * force.dot(d)) || !(left < before)) break; // converged to rounding of positions
    before = left;
    Vec3::Map(p) += moved;
    dissipated += (force - 0.5 * over).dot(moved); // equals the decrease of the stored elastic energy
  }
  return dissipated;
}

} // namespace

void ElasticGripGroup::add_forces(Evaluation& e) const {
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    double* const event_value = e.event_value + entry.first_event;
    event_value[0] = event_value[1] = event_value[2] = 1.0;
    if (is_apart(mode)) continue;
    const Motion<double>& m = e.link_motion[entry.link];
    const double* const p = e.inner + entry.inner;
    const StepLapFriction& friction = *entry.friction;
    const Vec3 force = friction.stiffness() * Vec3(m.x - p[0], m.y - p[1], m.theta - p[2]), rate(m.vx, m.vy, m.omega);
    BodyForce& on_limb = e.link_force[entry.link];
    on_limb.fx -= force[0];
    on_limb.fy -= force[1];
    on_limb.m -= force[2];
    if (elastic_state(mode) == k_elastic_holds) {
      event_value[0] = friction.spare(e, slid_at(p), force);
      continue;
    }
    const StepLapFriction::Flow flow = is_following(mode) ? friction.flow_along(e, slid_at(p), force, direction(p), rate)
                                                          : friction.flow_under(e, slid_at(p), force, rate);
    Vec3::Map(e.inner_rate + entry.inner) = flow.rate;
    Vec3::Map(e.inner_rate + entry.inner + k_direction) = k_direction_length * flow.turning;
    e.dissipation += force.dot(flow.rate);
    event_value[0] = flow.speed;
    event_value[2] = is_following(mode) ? 1.0 - flow.roundness / k_blunt : flow.roundness / k_sharp - 1.0;
    event_value[1] = std::min(friction.parting(e, slid_at(p), mode >> k_elastic_parted), friction.grip_beyond_last(e, slid_at(p)));
  }
}

double ElasticGripGroup::inner_energy(const Motion<double>* motion, const double* inner) const {
  double sum = 0.0;
  for (const ElementData& entry : entries) sum += stored(entry, motion, inner);
  return sum;
}

double ElasticGripGroup::jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const {
  const ElementData& entry = entries[element];
  double* const p = inner + entry.inner;
  if (is_apart(to)) {
    const double lost = stored(entry, e.motion, inner);
    p[k_lost] = 1.0;
    return lost;
  }
  if (!is_following(to)) Vec3::Map(p + k_direction).setZero();
  else if (direction(p).isZero(0.0)) Vec3::Map(p + k_direction) = k_direction_length * told_direction(entry, e, p);
  return 0.0;
}

void ElasticGripGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const ElementData& entry : entries) {
    PairJacobian& j = out.emplace_back();
    j.a = entry.a;
    j.b = entry.b;
    j.stiffness.setZero();
    j.damping.setZero();
    if (is_apart(e.mode[entry.unit])) continue;
    const Measures measures(entry, e);
    const Mat3& k = entry.friction->stiffness();
    D12 total[6];
    for (int r = 0; r < 3; ++r) {
      D12 wrench(0.0), along[6];
      for (int c = 0; c < 3; ++c) wrench -= D12(k(r, c)) * (measures.m[c].value - D12(e.inner[entry.inner + c]));
      measures.gradient(r, along);
      for (int i = 0; i < 6; ++i) total[i] += wrench * along[i];
    }
    for (int i = 0; i < 6; ++i) {
      j.stiffness.row(i) = total[i].d.template head<6>().matrix().transpose();
      j.damping.row(i) = total[i].d.template tail<6>().matrix().transpose();
    }
  }
}

// The flow depends on the strain, on p through strain and overlap, and linearly on the rate.
void ElasticGripGroup::add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const {
  for (const ElementData& entry : entries) {
    if (is_apart(e.mode[entry.unit]) || is_following(e.mode[entry.unit])) continue;
    const StepLapFriction& friction = *entry.friction;
    const Mat3& k = friction.stiffness();
    const Measures measures(entry, e);
    InnerJacobian& j = out.emplace_back();
    j.a = entry.a;
    j.b = entry.b;
    j.first = entry.inner;
    j.count = 3;
    // Derivatives of s with respect to the poses; of ṡ with respect to poses and velocities.
    Eigen::Matrix<double, 3, 6> gradient, turning, moving;
    for (int r = 0; r < 3; ++r) {
      D12 along[6];
      measures.gradient(r, along);
      for (int i = 0; i < 6; ++i) gradient(r, i) = along[i].v;
      turning.row(r) = measures.m[r].rate.d.template head<6>().matrix().transpose();
      moving.row(r) = measures.m[r].rate.d.template tail<6>().matrix().transpose();
    }
    j.force = gradient.transpose() * k;
    if (!is_yielding(e.mode[entry.unit])) continue;
    const double* const p = e.inner + entry.inner;
    const Vec3 s(measures.m[0].value.v, measures.m[1].value.v, measures.m[2].value.v);
    const Vec3 rate(measures.m[0].rate.v, measures.m[1].rate.v, measures.m[2].rate.v), now = s - Vec3::Map(p);
    const double size =
        std::max({std::abs(now[0]), std::abs(now[1]), friction.gyration() * std::abs(now[2]), k_least_step / k_strain_step});
    Mat3 by_strain, by_overlap;
    for (int c = 0; c < 3; ++c) {
      const double step = k_strain_step * size / (c < 2 ? 1.0 : friction.gyration());
      Vec3 d = Vec3::Zero();
      d[c] = step;
      const auto at = [&](const Vec3& strain_now, const Vec3& slid) {
        return friction.flow_under(e, {slid[0], slid[1], slid[2]}, k * strain_now, rate).rate;
      };
      by_strain.col(c) = (at(now + d, Vec3::Map(p)) - at(now - d, Vec3::Map(p))) / (2.0 * step);
      by_overlap.col(c) = (at(now, Vec3::Map(p) + d) - at(now, Vec3::Map(p) - d)) / (2.0 * step);
    }
    const StepLapFriction::Flow flow = friction.flow_under(e, slid_at(p), k * now, rate);
    const Mat3 by_rate = flow.direction * (k * flow.direction).transpose() / flow.resistance;
    j.by_pose = by_strain * gradient + by_rate * turning;
    j.by_velocity = by_rate * moving;
    j.by_inner = by_overlap - by_strain;
  }
}

// In mode `follows` the flow depends on p through the overlap, on the direction of slip, and linearly on the rate, but not on the strain.
void ElasticGripGroup::add_state_jacobian(const Evaluation& e, StateJacobian& out) const {
  for (const ElementData& entry : entries) {
    if (!is_following(e.mode[entry.unit])) continue;
    const StepLapFriction& friction = *entry.friction;
    const Measures measures(entry, e);
    const Eigen::Matrix<double, 3, 6> gradient = measures.gradient();
    const double* const p = e.inner + entry.inner;
    StepLapFriction::FlowSlopes slopes =
        friction.flow_slopes(e, slid_at(p), friction.stiffness() * (measures.values() - Vec3::Map(p)), direction(p), measures.rates());
    for (auto* const block : {&slopes.by_slid, &slopes.by_direction, &slopes.by_rate}) block->bottomRows<3>() *= k_direction_length;
    slopes.by_direction /= k_direction_length;
    const Eigen::Matrix<double, 6, 6> by_pose = slopes.by_rate * measures.rates_by_pose(), by_velocity = slopes.by_rate * gradient;
    const Eigen::Matrix<double, 6, 3> force = gradient.transpose() * friction.stiffness();
    const int body[2] = {entry.a, entry.b};
    for (int i = 0; i < 6; ++i) {
      for (int side = 0; side < 2; ++side) {
        if (body[side] == k_ground) continue;
        out.by_motion.push_back({entry.inner + i, body[side], by_pose.block<1, 3>(i, 3 * side), by_velocity.block<1, 3>(i, 3 * side)});
      }
      for (int c = 0; c < 3; ++c) {
        out.by_state.push_back({entry.inner + i, entry.inner + c, slopes.by_slid(i, c)});
        out.by_state.push_back({entry.inner + i, entry.inner + k_direction + c, slopes.by_direction(i, c)});
      }
    }
    for (int c = 0; c < 3; ++c)
      for (int side = 0; side < 2; ++side)
        if (body[side] != k_ground) out.forces.push_back({body[side], entry.inner + c, force.block<3, 1>(3 * side, c)});
  }
}

double ElasticGripGroup::project_inner(const Evaluation& e, double* inner) const {
  double dissipated = 0.0;
  for (const ElementData& entry : entries) {
    double* const p = inner + entry.inner;
    if (is_yielding(e.mode[entry.unit])) dissipated += return_to_surface(entry, e, p);
    if (is_following(e.mode[entry.unit])) dissipated += follow_direction(entry, e, p);
  }
  return dissipated;
}

void ElasticGripGroup::relax_inner(const Motion<double>* motion, double* inner) const {
  for (const ElementData& entry : entries) {
    const Pose now = entry.friction->pose_of(motion);
    Vec3::Map(inner + entry.inner) = Vec3(now.x, now.y, now.theta);
  }
}

void ElasticGripGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
}

void ElasticGripGroup::register_links(LinkTable& links) {
  for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
}

UnitMode ElasticGripGroup::initial_mode(int element, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  const double* const p = e.inner + entry.inner;
  if (p[k_lost] != 0.0) return k_elastic_apart; // came apart before an action deactivated the joint
  const Vec3 force = entry.friction->stiffness() * strain(entry.friction->pose_of(e.motion), p);
  return entry.friction->spare(e, slid_at(p), force) < 0.0 ? sliding_mode(entry, e, p) : k_elastic_holds;
}

UnitMode ElasticGripGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  const ElementData& entry = entries[element];
  const double* const p = e.inner + entry.inner;
  const UnitMode parts = mode & ~UnitMode{3};
  if (slot == 0) return parts | (elastic_state(mode) == k_elastic_holds ? sliding_mode(entry, e, p) : k_elastic_holds);
  if (slot == 2 && !is_yielding(mode) && !is_following(mode)) return mode; // another event at the same time has already ended the slip
  if (slot == 2) return parts | (is_following(mode) ? k_elastic_yields : k_elastic_follows);
  bool is_any_left = false;
  const UnitMode parted = entry.friction->parted_at(slid_at(p), is_any_left);
  is_any_left = is_any_left && entry.friction->grip_beyond_last(e, slid_at(p)) > k_on_surface;
  return parted << k_elastic_parted | (is_any_left ? elastic_state(mode) : k_elastic_apart);
}

EventKind ElasticGripGroup::event_kind(UnitMode from, UnitMode to) const {
  if (is_apart(to)) return EventKind::comes_apart;
  const UnitMode before = from >> k_elastic_parted, now = to >> k_elastic_parted;
  if (before != now) return (now & ~before) != 0 ? EventKind::loses_interface : EventKind::meets_interface;
  if (elastic_state(to) == k_elastic_holds) return EventKind::sticks;
  return elastic_state(from) == k_elastic_holds ? EventKind::slips : EventKind::none;
}

// --- elastic part of StepLapFriction

void StepLapFriction::make_elastic(const Mat3& stiffness, int inner, int unit) {
  stiffness_ = stiffness;
  Mat3 twist;
  for (int c = 0; c < 3; ++c) twist.col(c) = unscaled(Vec3::Unit(c));
  scaled_stiffness_ = twist.transpose() * stiffness * twist;
  inner_ = inner;
  unit_ = unit;
}

Mat3 StepLapFriction::spread_stiffness(const Pose& pose, double total) const {
  OverlapWorkspace workspace;
  Region region;
  Patch area({pose.x, pose.y});
  for (const SheetPair& s : sheets_) {
    intersect_exactly(s.yoke, s.limb, pose, workspace, region);
    area.add(region, s.count);
  }
  const Vec2 arm = area.centroid() - area.reference();
  const double second = area.gyration() * area.gyration() + arm.squaredNorm();
  Mat3 k;
  k << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x(), -arm.y(), arm.x(), second;
  return total * k;
}

Vec3 StepLapFriction::wrench(const Snapshot& s) const {
  if (!is_elastic()) return Vec3::Map(s.friction_force + row_);
  if (phase(s) == FrictionPhase::apart) return Vec3::Zero();
  const Pose now = pose_of(s.motion), slid = slid_pose(s);
  return -(stiffness_ * Vec3(now.x - slid.x, now.y - slid.y, now.theta - slid.theta));
}

FrictionPhase StepLapFriction::phase(const Snapshot& s) const {
  return is_elastic() ? phase_of_elastic(s.evaluation->mode[unit_]) : s.evaluation->friction[index_].phase;
}

Pose StepLapFriction::slid_pose(const Snapshot& s) const {
  if (!is_elastic()) return pose_of(s.motion);
  const double* p = s.evaluation->inner + inner_;
  return {p[0], p[1], p[2]};
}

} // namespace steplap
