#include "elements/machinery/rope.h"

#include "elements/contact_laws.h"
#include "elements/space_distance.h"
#include "mbd/base/dual.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/method.h"
#include "mbd/system/one_sided_row.h"
#include "mbd/system/rope_end.h"
#include "mbd/system/system.h"
#include "mbd/system/turn_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

using D12 = Dual<12>;

// A straight part between points of two bodies. Parts within one body only add to the length.
struct RopePart {
  int a = k_ground, b = k_ground;
  SpaceDistance measure;
  double given = 0.0;         ///< length in the reference pose, m
  std::string name_a, name_b; ///< names of its markers
};

// Elastic ropes. A rope is a contact with the coordinate −L and the tension as contact force: taut is pressed, slack is open, and a rope
// that shortens faster than its damped spring recovers is released. A taut rope over pulleys has one more event function: the length of its
// shortest part minus the length that counts as zero. That is the elongation of the rope (with a shorter part, the rest of the rope would
// be slack), but at most k_run_in of the part's given length (the load has then reached its pulley), and at least k_least_part of the
// rope's length, because a part of zero length has no direction.
class RopeGroup final : public ForceGroup {
public:
  static constexpr int k_event_count = KelvinVoigtContact::k_event_count + 1, k_on_pulley = KelvinVoigtContact::k_event_count;
  static constexpr double k_run_in = 1e-3; ///< length at which a part counts as run in, relative to its given length

  struct ElementData {
    std::vector<RopePart> parts;
    KelvinVoigtContact law;
    double fixed_length = 0.0; ///< length of parts within one body, m
    double count = 1.0;        ///< number of equal ropes; `law` is that of all together
    std::string name;
    int unit = 0, first_event = 0;
  };
  struct RopeLength {
    double length = 0.0, rate = 0.0;
  };
  struct PartLength {
    const RopePart* part = nullptr;
    double length = std::numeric_limits<double>::infinity(); ///< length in excess of one that counts as zero, m
  };
  std::vector<ElementData> entries;

  static RopeLength rope_length(const ElementData& entry, const Motion<double>* motion) {
    RopeLength way{entry.fixed_length, 0.0};
    for (const RopePart& part : entry.parts) {
      const auto m = part.measure.at<false, double>(motion[part.a], motion[part.b]);
      way.length += m.value;
      way.rate += m.rate;
    }
    return way;
  }
  /// Returns the rounding error of the length, m: the sum over all parts.
  static double rounding_of(const ElementData& entry, const Motion<double>* motion) {
    double sum = k_rounded_sum * entry.fixed_length;
    for (const RopePart& part : entry.parts) {
      const Motion<double>&a = motion[part.a], &b = motion[part.b];
      sum += value_rounding(part.measure.at<false, double>(a, b), a, b);
    }
    return sum;
  }
  /// Returns the part with the least length in excess of the length that counts as zero.
  static PartLength shortest_part_length(const ElementData& entry, double stretch, const Motion<double>* motion) {
    PartLength least;
    for (const RopePart& part : entry.parts) {
      const double now = part.measure.at<false, double>(motion[part.a], motion[part.b]).value;
      const double none = std::max(OneSidedRow::k_least_part * -entry.law.offset, std::min(stretch, k_run_in * part.given));
      if (now - none < least.length) least = {&part, now - none};
    }
    return least;
  }
  /// Returns the tension of one of the equal ropes, N.
  [[nodiscard]] double tension(int i, const Evaluation& e) const {
    const RopeLength way = rope_length(entries[i], e.motion);
    return entries[i].law.force(-way.length, -way.rate, e.mode[entries[i].unit]) / entries[i].count;
  }

  void add_forces(Evaluation& e) const override {
    for (const ElementData& entry : entries) {
      const RopeLength way = rope_length(entry, e.motion);
      const UnitMode mode = e.mode[entry.unit];
      const double f = entry.law.force(-way.length, -way.rate, mode);
      entry.law.event_value(-way.length, -way.rate, mode, e.event_value + entry.first_event, e.event_derivative + entry.first_event);
      const bool is_monitored = mode == k_contact_pressed && entry.parts.size() > 1;
      e.event_value[entry.first_event + k_on_pulley] =
          is_monitored ? shortest_part_length(entry, way.length + entry.law.offset, e.motion).length : 1.0;
      e.dissipation -= (entry.law.elastic_force(-way.length, mode) - f) * way.rate;
      if (f == 0.0) continue;
      for (const RopePart& part : entry.parts) {
        const auto m = part.measure.at<false, double>(e.motion[part.a], e.motion[part.b]);
        const Pair<double> pull = -f * m.direction; // force on a, directed towards b
        add_at(e.force[part.a], m.lever_a, pull);
        add_at(e.force[part.b], m.lever_b, -1.0 * pull);
      }
    }
  }

  [[nodiscard]] double potential(const Motion<double>* motion) const override {
    double sum = 0.0;
    for (const ElementData& entry : entries) sum += entry.law.energy(-rope_length(entry, motion).length);
    return sum;
  }

  // Adds −T ∂²L/∂q² for each part, and −∂L/∂q (k ∂L + c ∂L̇) for each pair of parts.
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override {
    for (const ElementData& entry : entries) {
      const RopeLength way = rope_length(entry, e.motion);
      const UnitMode mode = e.mode[entry.unit];
      const double f = entry.law.force(-way.length, -way.rate, mode);
      for (const RopePart& one : entry.parts) {
        const Gradient g = gradient_of(one, e.motion);
        for (const RopePart& other : entry.parts) {
          const bool is_same = &one == &other;
          const Gradient h = is_same ? g : gradient_of(other, e.motion);
          // Derivative of the tension k L + c L̇ with respect to poses and velocities of the bodies at the part `other`: the length and
          // rate of the whole rope, with the derivatives of those of this part.
          const D12 length = h.length + D12(way.length - h.length.v), rate = h.rate + D12(way.rate - h.rate.v);
          const D12 change = entry.law.force(-length, -rate, mode);
          if (is_same) add_whole(one, g, f, change, out);
          else add_blocks(one, other, g, change, out);
        }
      }
    }
  }

  void mark_bodies(std::vector<char>& is_used) const override {
    for (const ElementData& entry : entries)
      for (const RopePart& part : entry.parts) is_used[part.a] = is_used[part.b] = 1;
  }
  void register_turns(TurnTable& turns) const override {
    for (const ElementData& entry : entries)
      for (const RopePart& part : entry.parts) turns.add(part.a, part.b, turning_of(part.measure));
  }
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override {
    const RopeLength way = rope_length(entries[element], e.motion);
    return entries[element].law.initial_mode(-way.length, -way.rate);
  }
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entries[element];
    const RopeLength way = rope_length(entry, e.motion);
    if (slot == k_on_pulley) {
      const RopePart& part = *shortest_part_length(entry, way.length + entry.law.offset, e.motion).part;
      throw rope_has_run_in(e.t, entry.name, part.name_a, part.name_b);
    }
    return entry.law.next_mode(mode, slot, -way.length, -way.rate, rounding_of(entry, e.motion));
  }
  [[nodiscard]] bool is_armed_at_entry(int element, UnitMode mode, int slot, const Evaluation& e) const override {
    const ElementData& entry = entries[element];
    return entry.law.is_armed_at_entry(mode, slot, -rope_length(entry, e.motion).length, rounding_of(entry, e.motion));
  }
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override {
    if (to == k_contact_open) return EventKind::enters_gap;
    return from == k_contact_open ? EventKind::closes_gap : KelvinVoigtContact::event_kind(from, to);
  }

private:
  struct Gradient {
    D12 length, rate; ///< with derivatives by the poses (first six) and velocities of a and b
    D12 j[6];         ///< derivatives of the part's length with respect to the poses of a and b
  };
  static Gradient gradient_of(const RopePart& part, const Motion<double>* motion) {
    const auto m = part.measure.at<false, D12>(seeded(motion[part.a], 0), seeded(motion[part.b], 3));
    const D12 couple_a = cross(m.lever_a, m.direction), couple_b = cross(m.lever_b, m.direction);
    return {m.value, m.rate, {m.direction.x, m.direction.y, couple_a, -m.direction.x, -m.direction.y, -couple_b}};
  }
  static void add_at(BodyForce& sum, const Pair<double>& lever, const Pair<double>& force) {
    sum.fx += force.x;
    sum.fy += force.y;
    sum.m += cross(lever, force);
  }
  // Adds the derivatives of the forces of a part with respect to the motion of its own bodies.
  static void add_whole(const RopePart& part, const Gradient& g, double f, const D12& change, std::vector<PairJacobian>& out) {
    PairJacobian& j = out.emplace_back();
    j.a = part.a;
    j.b = part.b;
    for (int i = 0; i < 6; ++i)
      for (int l = 0; l < 6; ++l) {
        j.stiffness(i, l) = -f * g.j[i].d[l] - g.j[i].v * change.d[l];
        j.damping(i, l) = -g.j[i].v * change.d[6 + l];
      }
  }
  // Adds the derivatives of the forces of one part with respect to the motion of the other part's bodies.
  static void add_blocks(const RopePart& one, const RopePart& other, const Gradient& g, const D12& change, std::vector<PairJacobian>& out) {
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 2; ++column) {
        const int x = row == 0 ? one.a : one.b, y = column == 0 ? other.a : other.b;
        if (x == k_ground || y == k_ground) continue;
        PairJacobian& j = out.emplace_back();
        j.a = x;
        j.b = x == y ? k_ground : y;
        j.stiffness.setZero();
        j.damping.setZero();
        const int at = x == y ? 0 : 3;
        for (int i = 0; i < 3; ++i)
          for (int l = 0; l < 3; ++l) {
            j.stiffness(i, at + l) = -g.j[3 * row + i].v * change.d[3 * column + l];
            j.damping(i, at + l) = -g.j[3 * row + i].v * change.d[6 + 3 * column + l];
          }
      }
  }
};

bool check(const Rope& e, SystemBuilder& builder) {
  const auto fails = [&builder](bool is_wrong, const char* message) {
    if (is_wrong) builder.error(message);
    return is_wrong;
  };
  bool is_bad =
      fails(e.length.has_value() + e.pretension.has_value() + e.slack.has_value() > 1, "give one of 'length', 'pretension' and 'slack'");
  is_bad |= fails(e.across > 0.0 && !e.over.empty(), "'across' is the offset of its two ends: give it to ropes that run over no points");
  if (!e.inextensible) return !fails(!e.stiffness, "give its 'stiffness', or inextensible = true") && !is_bad;
  is_bad |=
      fails(e.across > 0.0 || e.count > 1, "with inextensible = true it lies in the plane, and is one: give no 'across' and no 'count'");
  is_bad |= fails(e.stiffness.has_value(), "give either 'stiffness' or inextensible = true");
  is_bad |= fails(e.damping > 0.0, "with inextensible = true it has no 'damping': it does not stretch");
  is_bad |= fails(e.pretension.has_value(), "with inextensible = true its tension follows from the motion: give no 'pretension'");
  return !is_bad;
}

void refuse_time_stepping(SystemBuilder& builder) {
  const std::string& integrator = builder.model().simulation.integrator;
  for (const Method& m : methods())
    if (m.name == integrator && m.is_time_stepping)
      builder.error("'" + integrator +
                    "' does not locate where an inextensible rope becomes taut or slack: choose another "
                    "'integrator', auto for one, or give the rope a 'stiffness'");
}

double lightest_mass(const std::vector<RopePart>& parts, const SystemBuilder& builder) {
  double mass = std::numeric_limits<double>::infinity();
  for (const Body& body : builder.model().bodies) {
    const int index = builder.body(body.name);
    const auto is_at = [index](const RopePart& part) { return part.a == index || part.b == index; };
    const bool is_held = std::any_of(parts.begin(), parts.end(), is_at);
    if (is_held && !body.fixed) mass = std::min(mass, body.mass);
  }
  return std::isfinite(mass) ? mass : 0.0;
}

std::vector<RowSpec> rows_of(const std::vector<RopePart>& parts, SystemBuilder& builder) {
  std::vector<RowSpec> rows;
  for (const RopePart& part : parts) {
    RowSpec& row = rows.emplace_back();
    row.kind = MeasureKind::distance;
    row.a = part.a;
    row.b = part.b;
    row.point_a = part.measure.plane.point_a;
    row.point_b = part.measure.plane.point_b;
    row.quantity = "length";
    row.element = builder.element_index();
  }
  return rows;
}

// Adds an inextensible rope. `entry`: data as for an elastic rope; `now`: length in the reference pose, m; `length`: full length, m.
void add_inextensible(const RopeGroup::ElementData& entry, double now, double length, SystemBuilder& builder) {
  constexpr double k_least_acceleration = 1e-11; // tensions that accelerate the lightest body by less, m/s², are rounding
  // Dead band of the length: relative to the length; at least in m, above the residuals after projection.
  constexpr double k_dead_band = 1e-11, k_least_band = 4e-12;
  refuse_time_stepping(builder);
  if (now > length * (1.0 + OneSidedRow::k_too_long))
    return builder.error("its 'length' of " + rounded_text(length) + " m is less than the way over its points, " + rounded_text(now) +
                         " m: it does not stretch");
  auto rope = std::make_unique<OneSidedRow>();
  rope->length = length - entry.fixed_length;
  if (!(rope->length > 0.0)) return builder.error("its 'length' leaves nothing for what of it is between bodies");
  rope->dead_band = k_dead_band * rope->length + k_least_band;
  rope->rest_tension = k_least_acceleration * lightest_mass(entry.parts, builder);
  rope->set_parts(rows_of(entry.parts, builder));
  for (const RopePart& part : entry.parts) rope->points.emplace_back(part.name_a, part.name_b);
  rope->row.base = builder.add_base(rope->length);
  rope->impact = builder.add_impacts();
  const int force = builder.next_friction_row(), f = builder.next_friction(), impact = rope->impact;
  const OneSidedRow* const self = rope.get();
  builder.add_channel("length", "m", "length of the way over its points",
                      [self, fixed = entry.fixed_length](const Snapshot& s) { return fixed + self->measured(s.motion).value; });
  builder.add_channel("rate", "m/s", {"of that length", "positive: it grows"},
                      [self](const Snapshot& s) { return self->measured(s.motion).rate; });
  builder.add_channel("tension", "N", {"force all along it, zero while it is slack", "positive: it pulls"}, [force, f](const Snapshot& s) {
    return s.evaluation->friction[f].phase == FrictionPhase::stick ? -s.friction_force[force] : 0.0;
  });
  builder.add_channel("impulse", "N s", {"of the last blow that it took, zero before the first", "positive: it pulled"},
                      [impact](const Snapshot& s) { return s.impacts[impact].impulse; });
  builder.add_friction(std::move(rope));
}

void compile_rope(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Rope&>(element);
  if (!check(e, builder)) return;
  std::vector<std::string> names{e.a};
  names.insert(names.end(), e.over.begin(), e.over.end());
  names.push_back(e.b);
  RopeGroup::ElementData entry;
  entry.name = e.name;
  double now = 0.0;
  for (std::size_t i = 0; i + 1 < names.size(); ++i) {
    const CompiledMarker from = builder.marker(names[i]), to = builder.marker(names[i + 1]);
    const double in_plane = (builder.marker_position(to) - builder.marker_position(from)).norm(),
                 length = length_in_space(in_plane, e.across);
    now += length;
    if (from.body == to.body) {
      entry.fixed_length += length;
      continue;
    }
    if (in_plane < 1e-12)
      return builder.error("its points '" + names[i] + "' and '" + names[i + 1] +
                           "' coincide, so its direction there is undefined: move a marker");
    entry.parts.push_back({from.body, to.body, {{from.point, to.point}, e.across}, length, names[i], names[i + 1]});
  }
  if (entry.parts.empty()) return builder.error("joins a body with itself: name markers on two different bodies");
  double length = e.length.value_or(now);
  if (e.slack) length = now + *e.slack;
  if (e.inextensible) return add_inextensible(entry, now, length, builder);
  if (e.pretension) length = now - *e.pretension / *e.stiffness;
  if (!(length > 0.0)) return builder.error("its 'pretension' stretches it by more than its length: give more 'stiffness'");
  entry.count = static_cast<double>(e.count);
  entry.law = {entry.count * *e.stiffness, entry.count * e.damping, -length};
  RopeGroup& group = builder.group<RopeGroup>();
  group.entries.push_back(std::move(entry));
  builder.add_unit(group, RopeGroup::k_event_count);
  const int i = static_cast<int>(group.entries.size()) - 1;
  builder.add_channel("length", "m", "length of the way over its points",
                      [&group, i](const Snapshot& s) { return RopeGroup::rope_length(group.entries[i], s.motion).length; });
  builder.add_channel("rate", "m/s", {"of that length", "positive: it grows"},
                      [&group, i](const Snapshot& s) { return RopeGroup::rope_length(group.entries[i], s.motion).rate; });
  builder.add_channel("tension", "N", {"force all along one, zero while it is slack", "positive: it pulls"},
                      [&group, i](const Snapshot& s) { return group.tension(i, *s.evaluation); });
}

} // namespace

const ElementKind& rope_kind() {
  static const ElementKind kind = [] {
    using T = Rope;
    ElementKind k;
    k.name = "rope";
    k.goes_slack = true;
    k.doc = "A rope from marker a over any number of points to marker b: it pulls, it never pushes. The tension is the same "
            "all along; a point that it runs over is a pulley without size or friction. A lashing is a rope with a pretension. With "
            "`across` it leads out of the plane, and the part of its force in the plane acts.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("marker at its beginning");
    f.add("b", &T::b).as(FieldType::marker).doc("marker at its end");
    f.add("over", &T::over).doc("names of the markers that it runs over, in order from a to b");
    f.add("across", &T::across).in("m").not_negative().doc("distance of its ends across the plane; its length is that in space");
    f.add("count", &T::count).at_least(1).doc("equal ropes, all values are those of one; 2 for a pair to both sides of the plane");
    f.add("stiffness", &T::stiffness).in("N/m").positive().doc("of the whole rope; required unless it is inextensible");
    f.add("inextensible", &T::inextensible).doc("true: it does not stretch, and becomes taut by a blow without rebound");
    f.add("damping", &T::damping).in("N s/m").not_negative().doc("while it is taut; never pushes");
    f.add("length", &T::length).in("m").positive().doc("without load; default: the way over its points in the reference pose");
    f.add("pretension", &T::pretension).in("N").not_negative().doc("in the reference pose");
    f.add("slack", &T::slack).in("m").not_negative().doc("by which it is longer than the way in the reference pose");
    k.example = R"([[element]]
name = 'lashing'
kind = 'rope'
a = { body = 'a', point = [0.0, -0.5] }
b = { body = 'b', point = [0.0, 0.5] }
stiffness = 1e5
pretension = 1e3
)";
    k.holds<T>();
    k.compile = compile_rope;
    return k;
  }();
  return kind;
}

} // namespace steplap
