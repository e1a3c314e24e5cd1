#include "elements/step_lap_elastic.h"

#include "mbd/system/law_group.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using D12 = Dual<12>;

constexpr int k_most_returns = 5;      // each leaves the square of what the overlap changes by
constexpr double k_on_surface = 1e-15; // of u
constexpr double k_strain_step = 1e-5; // of the strain, for differences of the flow
constexpr double k_least_step = 1e-12; // m

Pose slid_at(const double* inner) { return {inner[0], inner[1], inner[2]}; }

bool is_apart(UnitMode mode) { return (mode & k_elastic_apart) != 0; }
bool is_yielding(UnitMode mode) { return (mode & (k_elastic_yields | k_elastic_apart)) == k_elastic_yields; }

/// s − p.
Vec3 strain(const Pose& now, const double* slid) { return {now.x - slid[0], now.y - slid[1], now.theta - slid[2]}; }

double stored(const ElasticGripGroup::Entry& entry, const Motion<double>* motion, const double* inner) {
  if (inner[entry.inner + 3] != 0.0) return 0.0;
  const Vec3 d = strain(entry.friction->pose_of(motion), inner + entry.inner);
  return 0.5 * d.dot(entry.friction->stiffness() * d);
}

/// The joint's three measures, with their derivatives by the motion of both bodies.
struct Measures {
  MeasureValue<D12> m[3];
  Measures(const ElasticGripGroup::Entry& entry, const Evaluation& e) {
    const Motion<D12> a = seeded(e.motion[entry.a], 0), b = seeded(e.motion[entry.b], 3);
    const RowSpec* hold = entry.friction->hold;
    for (int r = 0; r < 2; ++r) m[r] = AxisMeasure{hold[r].point_a, hold[r].point_b, hold[r].direction}.at<false, D12>(a, b);
    m[2] = AngleMeasure{}.at<false, D12>(a, b);
  }
  /// Force on a, force on b of a unit wrench along measure r.
  void gradient(int r, D12* j) const {
    const D12 rows[6] = {m[r].direction.x,  m[r].direction.y,  cross(m[r].lever_a, m[r].direction) + m[r].couple,
                         -m[r].direction.x, -m[r].direction.y, -(cross(m[r].lever_b, m[r].direction) + m[r].couple)};
    std::copy(rows, rows + 6, j);
  }
};

} // namespace

void ElasticGripGroup::add_forces(Evaluation& e) const {
  for (const Entry& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    double* const watch = e.watch + entry.watch;
    watch[0] = watch[1] = 1.0;
    if (is_apart(mode)) continue;
    const Motion<double>& m = e.link_motion[entry.link];
    const double* const p = e.inner + entry.inner;
    const Vec3 force = entry.friction->stiffness() * Vec3(m.x - p[0], m.y - p[1], m.theta - p[2]);
    BodyForce& on_limb = e.link_force[entry.link];
    on_limb.fx -= force[0];
    on_limb.fy -= force[1];
    on_limb.m -= force[2];
    if (!is_yielding(mode)) {
      watch[0] = entry.friction->spare(e, slid_at(p), force);
      continue;
    }
    const StepLapFriction::Flow flow = entry.friction->flow(e, slid_at(p), force, Vec3(m.vx, m.vy, m.omega));
    Vec3::Map(e.inner_rate + entry.inner) = flow.rate;
    e.dissipation += force.dot(flow.rate);
    watch[0] = flow.speed;
    watch[1] = std::min(entry.friction->parting(e, slid_at(p), mode >> k_elastic_parted), entry.friction->grip_beyond_last(e, slid_at(p)));
  }
}

double ElasticGripGroup::inner_energy(const Motion<double>* motion, const double* inner) const {
  double sum = 0.0;
  for (const Entry& entry : entries) sum += stored(entry, motion, inner);
  return sum;
}

double ElasticGripGroup::enter_mode(int element, UnitMode to, const Evaluation& e, double* inner) const {
  if (!is_apart(to)) return 0.0;
  const double lost = stored(entries[element], e.motion, inner);
  inner[entries[element].inner + 3] = 1.0;
  return lost;
}

void ElasticGripGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const Entry& entry : entries) {
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

// The flow depends on the strain, on p by the strain and the overlap, and, linearly, on the rate.
void ElasticGripGroup::add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const {
  for (const Entry& entry : entries) {
    if (is_apart(e.mode[entry.unit])) continue;
    const StepLapFriction& friction = *entry.friction;
    const Mat3& k = friction.stiffness();
    const Measures measures(entry, e);
    InnerJacobian& j = out.emplace_back();
    j.a = entry.a;
    j.b = entry.b;
    j.first = entry.inner;
    j.count = 3;
    Eigen::Matrix<double, 3, 6> gradient, turning, moving; // of s by the poses; of ṡ by the poses and the velocities
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
        return friction.flow(e, {slid[0], slid[1], slid[2]}, k * strain_now, rate).rate;
      };
      by_strain.col(c) = (at(now + d, Vec3::Map(p)) - at(now - d, Vec3::Map(p))) / (2.0 * step);
      by_overlap.col(c) = (at(now, Vec3::Map(p) + d) - at(now, Vec3::Map(p) - d)) / (2.0 * step);
    }
    const StepLapFriction::Flow flow = friction.flow(e, slid_at(p), k * now, rate);
    const Mat3 by_rate = flow.direction * (k * flow.direction).transpose() / flow.resistance;
    j.by_pose = by_strain * gradient + by_rate * turning;
    j.by_velocity = by_rate * moving;
    j.by_inner = by_overlap - by_strain;
  }
}

double ElasticGripGroup::settle_inner(const Evaluation& e, double* inner) const {
  double dissipated = 0.0;
  for (const Entry& entry : entries) {
    if (!is_yielding(e.mode[entry.unit])) continue;
    double* const p = inner + entry.inner;
    const Pose now = entry.friction->pose_of(e.motion);
    for (int i = 0; i < k_most_returns; ++i) {
      const Vec3 d = strain(now, p), force = entry.friction->stiffness() * d;
      const double u = entry.friction->yield_usage(e, slid_at(p), force);
      if (!std::isfinite(u) || u <= 0.0 || std::abs(u - 1.0) <= k_on_surface) break;
      const Vec3 moved = d - d / u;
      Vec3::Map(p) += moved;
      dissipated += (force * (0.5 + 0.5 / u)).dot(moved); // the energy that it had stored
    }
  }
  return dissipated;
}

void ElasticGripGroup::start_inner(const Motion<double>* motion, double* inner) const {
  for (const Entry& entry : entries) {
    const Pose now = entry.friction->pose_of(motion);
    Vec3::Map(inner + entry.inner) = Vec3(now.x, now.y, now.theta);
  }
}

void ElasticGripGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const Entry& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
}

void ElasticGripGroup::enter_links(LinkTable& links) {
  for (Entry& entry : entries) entry.link = links.add(entry.a, entry.b);
}

UnitMode ElasticGripGroup::initial_mode(int element, const Evaluation& e) const {
  const Entry& entry = entries[element];
  const double* const p = e.inner + entry.inner;
  const Vec3 force = entry.friction->stiffness() * strain(entry.friction->pose_of(e.motion), p);
  return entry.friction->spare(e, slid_at(p), force) < 0.0 ? k_elastic_yields : k_elastic_holds;
}

UnitMode ElasticGripGroup::next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const {
  const Entry& entry = entries[element];
  if (slot == 0) return mode ^ k_elastic_yields;
  bool is_any_left = false;
  const UnitMode parted = entry.friction->parted_at(slid_at(e.inner + entry.inner), is_any_left);
  is_any_left = is_any_left && entry.friction->grip_beyond_last(e, slid_at(e.inner + entry.inner)) > k_on_surface;
  return parted << k_elastic_parted | (is_any_left ? mode & k_elastic_yields : k_elastic_apart);
}

EventKind ElasticGripGroup::transition(UnitMode from, UnitMode to) const {
  if (is_apart(to)) return EventKind::comes_apart;
  const UnitMode before = from >> k_elastic_parted, now = to >> k_elastic_parted;
  if (before != now) return (now & ~before) != 0 ? EventKind::loses_interface : EventKind::meets_interface;
  return (to & k_elastic_yields) != 0 ? EventKind::slips : EventKind::sticks;
}

// --- what StepLapFriction knows of it ---------------------------------------------------------------------

void StepLapFriction::make_elastic(const Mat3& stiffness, int inner, int unit) {
  stiffness_ = stiffness;
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
