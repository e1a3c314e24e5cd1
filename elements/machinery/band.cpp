#include "elements/machinery/band.h"

#include "elements/machinery/sliding_band.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/method.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

using Group = SlidingBandGroup;

// Smallest length of a free part, relative to its length in the reference pose; equal to that of ropes.
constexpr double k_shortest = 1e-6;
constexpr double k_least_angle = 1e-6; // smallest wrap angle, rad; below it the band does not touch its drum

bool is_followed(SystemBuilder& builder) {
  const std::string& integrator = builder.model().simulation.integrator;
  for (const Method& m : methods())
    if (m.name == integrator && m.is_time_stepping) {
      builder.error("'" + integrator + "' does not follow what slides on a drum: choose another 'integrator', auto for one");
      return false;
    }
  return true;
}

// Returns false and reports an error if the distance of the centres is at most c, so that no common tangent exists.
bool has_tangent(const CompiledMarker& wheel, const CompiledMarker& end, double c, const char* what, SystemBuilder& builder) {
  const double apart = (builder.marker_position(end) - builder.marker_position(wheel)).norm();
  if (apart > c && apart > 1e-12) return true;
  builder.error(std::string(what) + " is " + rounded_text(apart) + " m from the drum's centre, but a straight part takes more than " +
                rounded_text(c) + " m");
  return false;
}

Group::Part part_of(int drum, const CompiledMarker& end, const WoundMeasure& measure, double stiffness, SystemBuilder& builder) {
  Group::Part part{end.body, measure, stiffness};
  const Motion<double>&at_drum = builder.reference(drum), &at_end = builder.reference(end.body);
  const auto straight = part.measure.straight(at_drum, at_end);
  part.measure.start = {straight.u.x, straight.u.y};
  part.measure.taken = -part.measure.at<false, double>(at_drum, at_end).value;
  part.shortest = k_shortest * straight.length;
  return part;
}

// Sets the free lengths so that in the reference pose both parts have the given pretension, or the band the given slack. The slack is
// distributed over the parts like an elongation by an equal negative tension.
void set_free_lengths(Group::ElementData& entry, const std::optional<double>& pretension, const std::optional<double>& slack) {
  const double k0 = entry.parts[0].stiffness, k1 = entry.parts[1].stiffness;
  const double pull = pretension ? *pretension : -slack.value_or(0.0) * k0 * k1 / (k0 + k1);
  entry.parts[0].free = -pull / k0;
  entry.parts[1].free = -pull / k1;
}

int add(Group& group, Group::ElementData entry, SystemBuilder& builder) {
  entry.inner = builder.add_inner(group, 0.0);
  group.entries.push_back(std::move(entry));
  builder.add_unit(group, Group::k_event_count);
  return static_cast<int>(group.entries.size()) - 1;
}

// Returns ln(larger tension/smaller tension)/(μ α), the fraction of the friction capacity in use; 1 at the bound.
double share_of(const Group::Flow<double>& flow) {
  const double least = std::min(flow.tension[0], flow.tension[1]), most = std::max(flow.tension[0], flow.tension[1]);
  if (!(most > 0.0)) return 0.0;
  return least > 0.0 ? std::min(1.0, portable::log10(most / least) / portable::log10(flow.ratio)) : 1.0;
}

void add_shared_channels(const Group& group, int i, SystemBuilder& builder) {
  builder.add_channel("slip", "m", {"way that it has slid over its drum", "positive: towards its second part"},
                      [inner = group.entries[static_cast<std::size_t>(i)].inner](const Snapshot& s) { return s.evaluation->inner[inner]; });
  builder.add_channel("slip_rate", "m/s", {"at which it slides", "positive: towards its second part"},
                      [&group, i](const Snapshot& s) { return group.flow_now(i, *s.evaluation).slip; });
  builder
      .add_channel("share", "", "of what friction can hold, by the logarithm of the ratio of tensions; 1 where it slides",
                   [&group, i](const Snapshot& s) { return share_of(group.flow_now(i, *s.evaluation)); })
      .role = ChannelRole::friction_use;
  builder.add_channel("mode", "", {"state", "", "0 loose, 1 sticks, 2 slides"},
                      [unit = group.entries[static_cast<std::size_t>(i)].unit](const Snapshot& s) {
                        const UnitMode mode = s.evaluation->mode[unit];
                        return mode < Group::k_sticks ? 0.0 : mode == Group::k_sticks ? 1.0 : 2.0;
                      });
}

void compile_band(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Band&>(element);
  if (e.pretension && e.slack) return builder.error("give either 'pretension' or 'slack'");
  if (!is_followed(builder)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b), drum = builder.marker(e.drum);
  if (a.body == drum.body && b.body == drum.body) return builder.error("joins a drum with itself: name a marker on another body");
  if (drum.body != k_ground && (a.body == drum.body || b.body == drum.body))
    return builder.error("an end of it is fastened to a drum that moves: name a marker on another body");
  if (e.radius == 0.0) return builder.error("'radius' is 0: a point holds nothing by friction");
  if (!has_tangent(drum, a, std::abs(e.radius), "marker 'a'", builder) || !has_tangent(drum, b, std::abs(e.radius), "marker 'b'", builder))
    return;
  const double sense = e.radius < 0.0 ? -1.0 : 1.0;
  Group::ElementData entry;
  entry.drum = drum.body;
  entry.name = e.name;
  entry.friction[0] = e.friction;
  entry.sense = sense;
  entry.time = e.damping / e.stiffness;
  entry.parts[0] = part_of(drum.body, a, {drum.point, a.point, e.radius, 0.0}, e.stiffness, builder);
  entry.parts[1] = part_of(drum.body, b, {drum.point, b.point, -e.radius, 0.0}, e.stiffness_b.value_or(e.stiffness), builder);
  // The wrap angle is the angle between the radii to the points where the band reaches and leaves the drum. These radii are perpendicular
  // to the free parts, so the angle follows from the directions of the parts.
  const Vec2 &first = entry.parts[0].measure.start, &second = entry.parts[1].measure.start;
  const double between = sense * portable::atan2(first.x() * second.y() - first.y() * second.x(), first.dot(second)) - std::numbers::pi;
  constexpr double k_turn = 2.0 * std::numbers::pi;
  entry.angle = between - k_turn * std::floor(between / k_turn) + k_turn * static_cast<double>(e.turns);
  if (entry.angle < k_least_angle)
    return builder.error("its free parts lie in one line, which only touches the drum: move an end, or change the sign of 'radius'");
  set_free_lengths(entry, e.pretension, e.slack);
  Group& group = builder.group<Group>();
  const int i = add(group, std::move(entry), builder);
  for (const int side : {0, 1})
    builder.add_channel(
        side == 0 ? "tension_a" : "tension_b", "N", {side == 0 ? "of its part at a" : "of its part at b", "positive: it pulls"},
        [&group, i, side](const Snapshot& s) { return group.flow_now(i, *s.evaluation).tension[static_cast<std::size_t>(side)]; });
  builder.add_channel("couple", "N m", {"what it turns the drum with, about its centre", "positive counter-clockwise"},
                      [&group, i, radius = e.radius](const Snapshot& s) {
                        const auto flow = group.flow_now(i, *s.evaluation);
                        return radius * (flow.tension[1] - flow.tension[0]);
                      });
  builder.add_channel("angle", "rad", {"at which it lies on the drum", "never negative"},
                      [&group, i](const Snapshot& s) { return group.flow_now(i, *s.evaluation).angles[0]; });
  add_shared_channels(group, i, builder);
}

void compile_belt(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const Belt&>(element);
  if (e.pretension && e.slack) return builder.error("give either 'pretension' or 'slack'");
  if (!is_followed(builder)) return;
  const CompiledMarker a = builder.marker(e.a), b = builder.marker(e.b);
  if (a.body == b.body) return builder.error("joins a body with itself: name markers on two different bodies");
  const double far = e.crossed ? e.radius_b : -e.radius_b;
  const double c =
      e.crossed ? e.radius_a + e.radius_b : std::max(e.radius_a, e.radius_b); // open belt: no centre may lie inside the other wheel
  if (!has_tangent(a, b, c, "the second wheel's centre", builder)) return;
  Group::ElementData entry;
  entry.drum = a.body;
  entry.name = e.name;
  entry.is_belt = true;
  entry.far_sign = e.crossed ? 1.0 : -1.0;
  entry.friction = {e.friction_a, e.friction_b};
  entry.time = e.damping / e.stiffness;
  entry.parts[0] = part_of(a.body, b, {a.point, b.point, e.radius_a, far}, e.stiffness, builder);
  entry.parts[1] = part_of(a.body, b, {a.point, b.point, -e.radius_a, -far}, e.stiffness, builder);
  set_free_lengths(entry, e.pretension, e.slack);
  Group& group = builder.group<Group>();
  const int i = add(group, std::move(entry), builder);
  for (const int side : {0, 1})
    builder.add_channel(
        side == 0 ? "tension_1" : "tension_2", "N",
        {side == 0 ? "of the part that wheel a takes in when it turns counter-clockwise" : "of the part that it then lets out",
         "positive: it pulls"},
        [&group, i, side](const Snapshot& s) { return group.flow_now(i, *s.evaluation).tension[static_cast<std::size_t>(side)]; });
  builder.add_channel("couple", "N m", {"what it turns wheel a with, about its centre", "positive counter-clockwise"},
                      [&group, i, radius = e.radius_a](const Snapshot& s) {
                        const auto flow = group.flow_now(i, *s.evaluation);
                        return radius * (flow.tension[1] - flow.tension[0]);
                      });
  add_shared_channels(group, i, builder);
}

} // namespace

const ElementKind& band_kind() {
  static const ElementKind kind = [] {
    using T = Band;
    ElementKind k;
    k.name = "band";
    k.doc = "A rope or band from marker a round a drum to marker b, which sticks to the drum while the ratio of its tensions is within "
            "exp(friction*angle) either way, and slides at that ratio: a rope round a bollard, a band brake.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("where it begins");
    f.add("b", &T::b).as(FieldType::marker).doc("where it ends");
    f.add("drum", &T::drum).as(FieldType::marker).doc("centre of the drum");
    f.add("radius", &T::radius)
        .in("m")
        .required()
        .doc("of the drum: positive where it goes round it counter-clockwise on the way from a to b, negative where clockwise");
    f.add("turns", &T::turns).at_least(0).at_most(100).doc("whole turns round the drum, in addition to the angle between its free parts");
    f.add("friction", &T::friction).positive().at_most(10.0).required().doc("coefficient between band and drum");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("of the free part at a");
    f.add("stiffness_b", &T::stiffness_b).in("N/m").positive().doc("of the free part at b; default: as at a");
    f.add("damping", &T::damping)
        .in("N s/m")
        .positive()
        .required()
        .doc("of the free part at a, at b in proportion to the stiffness; damping/stiffness is the time that a slide takes to settle");
    f.add("pretension", &T::pretension).in("N").not_negative().doc("in the reference pose");
    f.add("slack", &T::slack).in("m").not_negative().doc("by which it is longer than the way in the reference pose");
    f.add("source", &T::source).doc("where the friction comes from: above 0.8 results name it, from 1.2 on no verdict is hold without it");
    k.example = R"([[element]]
name = 'band'
kind = 'band'
a = 'a'
b = { body = 'ground', at = [3.0, -2.0] }
drum = 'b'
radius = 0.5
friction = 0.3
stiffness = 1e4
damping = 10.0
)";
    k.holds<T>();
    k.compile = compile_band;
    k.friction = [](const Element& element) {
      const auto& e = static_cast<const T&>(element);
      return GivenFriction{"friction", e.friction, e.source};
    };
    return k;
  }();
  return kind;
}

const ElementKind& belt_kind() {
  static const ElementKind kind = [] {
    using T = Belt;
    ElementKind k;
    k.name = "belt";
    k.doc = "An endless belt round two wheels, open or crossed, which sticks to both while the ratio of the tensions of its free parts is "
            "within exp(friction*angle), and slides on the wheel where that is least.";
    FieldTable& f = k.fields;
    f.add("a", &T::a).as(FieldType::marker).required().doc("centre of the first wheel");
    f.add("b", &T::b).as(FieldType::marker).doc("centre of the second wheel");
    f.add("radius_a", &T::radius_a).in("m").positive().required().doc("of the first wheel");
    f.add("radius_b", &T::radius_b).in("m").positive().required().doc("of the second wheel");
    f.add("crossed", &T::crossed).doc("true: the wheels turn against each other");
    f.add("friction_a", &T::friction_a).positive().at_most(10.0).required().doc("coefficient on the first wheel");
    f.add("friction_b", &T::friction_b).positive().at_most(10.0).required().doc("coefficient on the second wheel");
    f.add("stiffness", &T::stiffness).in("N/m").positive().required().doc("of each free part");
    f.add("damping", &T::damping)
        .in("N s/m")
        .positive()
        .required()
        .doc("of each free part; damping/stiffness is the time that a slide takes to settle");
    f.add("pretension", &T::pretension).in("N").not_negative().doc("of each free part in the reference pose");
    f.add("slack", &T::slack).in("m").not_negative().doc("by which it is longer than the way in the reference pose");
    f.add("source", &T::source).doc("where the friction comes from: above 0.8 results name it, from 1.2 on no verdict is hold without it");
    k.example = R"([[element]]
name = 'belt'
kind = 'belt'
a = 'a'
b = 'b'
radius_a = 0.3
radius_b = 0.5
friction_a = 0.3
friction_b = 0.3
stiffness = 1e4
damping = 10.0
pretension = 50.0
)";
    k.holds<T>();
    k.compile = compile_belt;
    k.friction = [](const Element& element) {
      const auto& e = static_cast<const T&>(element);
      return e.friction_b > e.friction_a ? GivenFriction{"friction_b", e.friction_b, e.source}
                                         : GivenFriction{"friction_a", e.friction_a, e.source};
    };
    return k;
  }();
  return kind;
}

} // namespace steplap
