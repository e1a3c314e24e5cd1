#include "elements/step_lap/step_lap_edges.h"

#include "mbd/system/law_group.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

using D12 = Dual<12>;

// Least cosine between the outward normal of a side of the overlap and the direction to the yoke (60°): such a side is the end of the limb.
constexpr double k_facing = 0.5;

bool is_whole(double d1, double d2) { return d1 >= 0.0 && d2 >= 0.0; }

/// Returns ∂U/∂d at both ends of a line. In mode k_bed_whole the law for closed ends is used whatever the sign of d, so that the force is
/// smooth until the event.
template <class S> EdgePress<S> press(const S& d1, const S& d2, double k, double length, UnitMode mode) {
  EdgePress<S> out;
  const S unit(k * length / 6.0);
  if (mode == k_bed_whole || is_whole(value_of(d1), value_of(d2))) {
    out.force[0] = unit * (S(2) * d1 + d2);
    out.force[1] = unit * (d1 + S(2) * d2);
    return out;
  }
  const int near = value_of(d1) > value_of(d2) ? 0 : 1;
  const S& d = near == 0 ? d1 : d2;
  const S& far = near == 0 ? d2 : d1;
  if (value_of(d) <= 0.0) return out;
  const S share = d / (d - far); // fraction of the length that is in contact
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

// Gap and rate at the ends of a bed with the smallest and the largest gap.
struct BedGaps {
  double least = std::numeric_limits<double>::infinity(), least_rate = 0.0;
  double most = -std::numeric_limits<double>::infinity(), most_rate = 0.0;

  template <class Measured> void add(const Measured& gap) {
    if (gap.value < least) {
      least = gap.value;
      least_rate = gap.rate;
    }
    if (gap.value > most) {
      most = gap.value;
      most_rate = gap.rate;
    }
  }
};

BedGaps gaps_of(const EdgeGroup::ElementData& bed, const Motion<double>* motion) {
  BedGaps gaps;
  for (const EdgeGroup::Line& line : bed.lines)
    for (const AxisMeasure& gap : line.gap) gaps.add(gap.at<false, double>(motion[bed.a], motion[bed.b]));
  return gaps;
}

} // namespace

void EdgeGroup::add_forces(Evaluation& e) const {
  for (const ElementData& entry : entries) {
    const Motion<double>& link = e.link_motion[entry.link];
    const UnitMode mode = e.mode[entry.unit];
    BedGaps gaps;
    for (const Line& line : entry.lines) {
      const auto one = line.gap[0].at<false, double>(link, Origin{}), two = line.gap[1].at<false, double>(link, Origin{});
      gaps.add(one);
      gaps.add(two);
      if (mode == k_bed_open) continue;
      const auto p = press(-one.value, -two.value, line.stiffness, line.length, mode);
      apply_force(e.link_force[entry.link], one, p.force[0]);
      apply_force(e.link_force[entry.link], two, p.force[1]);
    }
    const double closing = mode == k_bed_open ? 1.0 : -1.0, filling = mode == k_bed_whole ? -1.0 : 1.0;
    e.event_value[entry.first_event] = closing * gaps.least;
    e.event_derivative[entry.first_event] = closing * gaps.least_rate;
    e.event_value[entry.first_event + 1] = filling * gaps.most;
    e.event_derivative[entry.first_event + 1] = filling * gaps.most_rate;
  }
}

double EdgeGroup::potential(const Motion<double>* motion) const {
  double sum = 0.0;
  for (const ElementData& entry : entries)
    for (const Line& line : entry.lines) {
      const auto depth = [&](int end) { return -line.gap[end].at<false, double>(motion[entry.a], motion[entry.b]).value; };
      sum += energy(depth(0), depth(1), line.stiffness, line.length);
    }
  return sum;
}

void EdgeGroup::add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const {
  for (const ElementData& entry : entries) {
    const UnitMode mode = e.mode[entry.unit];
    if (mode == k_bed_open) continue;
    const auto a = seeded(e.motion[entry.a], 0), b = seeded(e.motion[entry.b], 3);
    for (const Line& line : entry.lines) {
      const D12 gap[2] = {line.gap[0].at<false, D12>(a, b).value, line.gap[1].at<false, D12>(a, b).value};
      const auto p = press(-gap[0], -gap[1], line.stiffness, line.length, mode);
      for (int end = 0; end < 2; ++end)
        add_pair_jacobian(
            entry.a, entry.b, line.gap[end], e, [&](const D12&, const D12&) { return p.force[end]; }, out);
    }
  }
}

void EdgeGroup::mark_bodies(std::vector<char>& is_used) const {
  for (const ElementData& entry : entries) is_used[entry.a] = is_used[entry.b] = 1;
}

void EdgeGroup::register_links(LinkTable& links) {
  for (ElementData& entry : entries) entry.link = links.add(entry.a, entry.b);
}

UnitMode EdgeGroup::initial_mode(int element, const Evaluation& e) const {
  const BedGaps gaps = gaps_of(entries[element], e.motion);
  return gaps.most < 0.0 ? k_bed_whole : gaps.least < 0.0 ? k_bed_partly : k_bed_open;
}

// A gap of zero counts as closed if it decreases. If a bed closes parallel to its yoke, both event functions fire at once, in either order;
// the result is the same.
UnitMode EdgeGroup::next_mode(int element, UnitMode, int slot, const Evaluation& e) const {
  constexpr double k_parallel = 1e-9; // rad: a bed at a smaller angle to its yoke counts as parallel
  const ElementData& entry = entries[element];
  double length = 0.0;
  for (const Line& line : entry.lines) length = std::max(length, line.length);
  const BedGaps gaps = gaps_of(entry, e.motion);
  const auto is_pressed = [&](double gap, double rate, bool is_asked) {
    return is_asked || std::abs(gap) < k_parallel * length ? rate < 0.0 : gap < 0.0;
  };
  if (is_pressed(gaps.most, gaps.most_rate, slot == 1)) return k_bed_whole;
  return is_pressed(gaps.least, gaps.least_rate, slot == 0) ? k_bed_partly : k_bed_open;
}

EventKind EdgeGroup::event_kind(UnitMode from, UnitMode to) const {
  if (from == k_bed_open) return EventKind::closes;
  return to == k_bed_open ? EventKind::opens : EventKind::passes_kink;
}

EdgeGroup::Bearing EdgeGroup::bearing(int element, const Motion<double>* motion) const {
  const ElementData& entry = entries[element];
  Bearing bearing;
  for (const Line& line : entry.lines) {
    double depth[2];
    for (int end = 0; end < 2; ++end) depth[end] = -line.gap[end].at<false, double>(motion[entry.a], motion[entry.b]).value;
    const auto p =
        press(depth[0], depth[1], line.stiffness, line.length, k_bed_partly); // any mode but k_bed_whole: the penetrations decide
    bearing.force += p.force[0] + p.force[1];
    for (int end = 0; end < 2; ++end) bearing.load[end] += line.stiffness * std::max(0.0, depth[end]);
  }
  return bearing;
}

EdgeLine find_edge_line(const SheetPair& sheets, const Pose& reference) {
  OverlapWorkspace workspace;
  Region region;
  EdgeLine line;
  intersect_exactly(sheets.yoke, sheets.limb, reference, workspace, region);
  Vec2 to_yoke =
      sheets.across ? Vec2(-*sheets.across) : Vec2(centroid(sheets.yoke.polygon) - placed(centroid(sheets.limb.polygon), reference));
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
