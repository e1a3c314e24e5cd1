#include "elements/step_lap_edges.h"

#include "mbd/system/law_group.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using D12 = Dual<12>;

// A side of the overlap belongs to the limb's end if its outward normal is within 60° of the way to the yoke.
constexpr double k_facing = 0.5;

/// ∂U/∂d of the smooth piece that `mode` names; beyond it, where d has another sign, the neighbouring piece.
template <class S> EdgePress<S> press(const S& d1, const S& d2, double k, double length, UnitMode mode) {
  EdgePress<S> out;
  const S unit(k * length / 6.0);
  if (mode == 0) return out;
  const bool is_whole = mode == (k_edge_end_1 | k_edge_end_2);
  const int near = mode == k_edge_end_2 ? 1 : 0;
  const S& d = near == 0 ? d1 : d2;
  const S& far = near == 0 ? d2 : d1;
  if (!is_whole && value_of(d) <= 0.0) return out;
  if (is_whole || value_of(far) >= 0.0) {
    out.force[0] = unit * (S(2) * d1 + d2);
    out.force[1] = unit * (d1 + S(2) * d2);
    return out;
  }
  const S share = d / (d - far); // of the length that bears
  out.force[near] = unit * share * share * (S(2) * d - S(3) * far);
  out.force[1 - near] = unit * share * share * d;
  return out;
}

double energy(double d1, double d2, double k, double length) {
  const double high = std::max(d1, d2), low = std::min(d1, d2);
  if (high <= 0.0) return 0.0;
  if (low >= 0.0) return k * length * (d1 * d1 + d1 * d2 + d2 * d2) / 6.0;
  return k * length * high * high * high / (6.0 * (high - low));
}

UnitMode mode_of(double d1, double d2) {
  return (d1 > 0.0 ? k_edge_end_1 : 0) | (d2 > 0.0 ? k_edge_end_2 : 0);
}

} // namespace

void EdgeGroup::add_forces(Evaluation& e) const {
  for (const Entry& entry : entries) {
    const Motion<double>& link = e.link_motion[entry.link];
    const UnitMode mode = e.mode[entry.unit];
    const auto one = entry.gap[0].at<false, double>(link, Origin{}),
               two = entry.gap[1].at<false, double>(link, Origin{});
    double* const watch = e.watch + entry.watch;
    double* const watch_rate = e.watch_rate + entry.watch;
    const double sign[2] = {(mode & k_edge_end_1) != 0 ? -1.0 : 1.0, (mode & k_edge_end_2) != 0 ? -1.0 : 1.0};
    watch[0] = sign[0] * one.value;
    watch[1] = sign[1] * two.value;
    watch_rate[0] = sign[0] * one.rate;
    watch_rate[1] = sign[1] * two.rate;
    if (mode == 0) continue;
    const auto p = press(-one.value, -two.value, entry.stiffness, entry.length, mode);
    apply_force(e.link_force[entry.link], one, p.force[0]);
    apply_force(e.link_force[entry.link], two, p.force[1]);
  }
}

double EdgeGroup::potential(const Motion<double>* motion) const {
  double sum = 0.0;
  for (const Entry& entry : entries) {
    const auto depth = [&](int end) {
      return -entry.gap[end].at<false, double>(motion[entry.a], motion[entry.b]).value;
    };
    sum += energy(depth(0), depth(1), entry.stiffness, entry.length);
  }
  return sum;
}

void EdgeGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const Entry& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    if (mode == 0) continue;
    const auto a = seeded(e.motion[entry.a], 0), b = seeded(e.motion[entry.b], 3);
    const D12 gap[2] = {entry.gap[0].at<false, D12>(a, b).value, entry.gap[1].at<false, D12>(a, b).value};
    const auto p = press(-gap[0], -gap[1], entry.stiffness, entry.length, mode);
    for (int end = 0; end < 2; ++end)
      add_pair_jacobian(
          entry.a, entry.b, entry.gap[end], e, [&](const D12&, const D12&) { return p.force[end]; }, out);
  }
}

void EdgeGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const Entry& entry : entries)
    is_used[entry.a] = is_used[entry.b] = 1;
}

void EdgeGroup::enter_links(LinkTable& links) {
  for (Entry& entry : entries)
    entry.link = links.add(entry.a, entry.b);
}

UnitMode EdgeGroup::initial_mode(int element, const Evaluation& e) const {
  const Entry& entry = entries[element];
  const auto depth = [&](int end) {
    return -entry.gap[end].at<false, double>(e.motion[entry.a], e.motion[entry.b]).value;
  };
  return mode_of(depth(0), depth(1));
}

UnitMode EdgeGroup::next_mode(int, UnitMode mode, int slot, const Evaluation&) const {
  return mode ^ (slot == 0 ? k_edge_end_1 : k_edge_end_2);
}

EventKind EdgeGroup::transition(UnitMode from, UnitMode to) const {
  if (from == 0) return EventKind::closes;
  return to == 0 ? EventKind::opens : EventKind::passes_kink;
}

EdgeGroup::Bearing EdgeGroup::bearing(int element, const Motion<double>* motion) const {
  const Entry& entry = entries[element];
  double depth[2];
  for (int end = 0; end < 2; ++end)
    depth[end] = -entry.gap[end].at<false, double>(motion[entry.a], motion[entry.b]).value;
  const auto p = press(depth[0], depth[1], entry.stiffness, entry.length, mode_of(depth[0], depth[1]));
  Bearing bearing;
  bearing.force = p.force[0] + p.force[1];
  for (int end = 0; end < 2; ++end)
    bearing.load[end] = entry.stiffness * std::max(0.0, depth[end]);
  return bearing;
}

EdgeLine find_edge_line(const SheetPair& sheets, const Pose& reference) {
  OverlapWorkspace workspace;
  Region region;
  EdgeLine line;
  intersect_exactly(sheets.yoke, sheets.limb, reference, workspace, region);
  Vec2 to_yoke = sheets.across ? Vec2(-*sheets.across)
                               : Vec2(centroid(sheets.yoke.polygon) - placed(centroid(sheets.limb.polygon), reference));
  if (region.empty() || to_yoke.isZero(0.0)) return line;
  to_yoke.normalize();
  double longest = 0.0;
  for (const Polygon& piece : region)
    for (std::size_t i = 0; i < piece.outer.size(); ++i) {
      const Vec2 &p = piece.outer[i], &q = piece.outer[(i + 1) % piece.outer.size()];
      const double length = (q - p).norm();
      const Vec2 outward = Vec2(q.y() - p.y(), p.x() - q.x()) / length;
      if (length <= longest || outward.dot(to_yoke) < k_facing) continue;
      longest = length;
      line.ends[0] = p;
      line.ends[1] = q;
      line.off = -outward;
    }
  return line;
}

} // namespace steplap
