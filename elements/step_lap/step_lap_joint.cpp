#include "elements/step_lap/step_lap_joint.h"

#include "elements/step_lap/step_lap_criteria.h"
#include "elements/step_lap/step_lap_edges.h"
#include "elements/step_lap/step_lap_elastic.h"
#include "elements/step_lap/step_lap_friction.h"
#include "elements/step_lap/step_lap_interface.h"
#include "elements/step_lap/step_lap_shares.h"
#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <typeinfo>
#include <utility>

namespace steplap {

namespace {

constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();

void add_wrench_channels(SystemBuilder& builder, const StepLapFriction& friction) {
  const auto* self = &friction;
  const int b = friction.hold[0].b;
  builder.add_channel("fx", "N", {"force on the limb", "along x of the ground axes"}, [self, b](const Snapshot& s) {
    const Vec3 w = self->wrench(s);
    return s.motion[b].c * w[0] - s.motion[b].s * w[1];
  });
  builder.add_channel("fy", "N", {"force on the limb", "along y of the ground axes"}, [self, b](const Snapshot& s) {
    const Vec3 w = self->wrench(s);
    return s.motion[b].s * w[0] + s.motion[b].c * w[1];
  });
  builder.add_channel("m", "N m", {"couple on the limb about its centre of gravity", "positive counter-clockwise"},
                      [self](const Snapshot& s) { return self->wrench(s)[2]; });
}

// Returns a signal for the pressures. Reports an error if it jumps during the run, because a sticking joint would have to slip
// instantaneously.
const Signal* steady_signal(SystemBuilder& builder, const std::string& name, const char* field) {
  const Signal* signal = builder.signal(name);
  if (!signal) return nullptr;
  for (std::size_t k = 0; k < signal->breakpoints().size(); ++k)
    if (signal->breakpoints()[k] > 0.0 && signal->jumps_at(k)) {
      builder.error("'" + std::string(field) + "': signal '" + name + "' jumps at t = " + rounded_text(signal->breakpoints()[k]) +
                    " s; a clamping pressure changes within some time: a trapezoid, or a record between lines");
      break;
    }
  return signal;
}

void add_usage_channels(SystemBuilder& builder, const StepLapFriction& friction, const StepLapInterface& first) {
  const auto* self = &friction;
  // Returns the pressure of the first interface at the centroid of its overlap, Pa.
  const auto pressure_at = [self, nominal = first.pressure, share = first.transverse_pressure / first.pressure](double t) {
    const PressureState now = self->pressure_at(t);
    return nominal * now.factor * std::max(0.0, 1.0 + share * now.tilt);
  };
  builder
      .add_channel("u", "", {"share of the friction capacity in use; slides at 1", "never negative"},
                   [self](const Snapshot& s) { return self->usage(s).u; })
      .bounds = [self](const Snapshot& s) { return self->usage_between(s); };
  builder
      .add_channel("p_req", "Pa",
                   "required pressure: all pressures scaled together so that the joint just holds, "
                   "that of its first interface",
                   [self, pressure_at](const Snapshot& s) { return self->usage(s).u * pressure_at(s.t); })
      .bounds = [self, pressure_at](const Snapshot& s) {
    const ValueBounds u = self->usage_between(s);
    const double pressure = pressure_at(s.t);
    return ValueBounds{u.low * pressure, u.high * pressure};
  };
  if (self->has_changing_pressure())
    builder.add_channel("pressure", "Pa", "clamping pressure that the first interface has now, at the middle of its overlap",
                        [pressure_at](const Snapshot& s) { return pressure_at(s.t); });
  Channel& margin = builder.add_channel("margin", "", "capacity over what is in use, 1/u; infinite without load",
                                        [self](const Snapshot& s) { return self->usage(s).margin(); });
  margin.role = ChannelRole::margin;
  margin.bounds = [self](const Snapshot& s) {
    const ValueBounds u = self->usage_between(s);
    return ValueBounds{1.0 / u.high, 1.0 / u.low};
  };
  for (const int axis : {0, 1})
    builder
        .add_channel(axis == 0 ? "centre_x" : "centre_y", "m",
                     {"centre about which the limb would start to turn, from the active part's centre of gravity; not a "
                      "number at infinity (translation)",
                      axis == 0 ? "along x of the active part's axes" : "along y of the active part's axes"},
                     [self, axis](const Snapshot& s) {
                       const auto& centre = self->usage(s).centre;
                       return centre ? self->in_part(*centre)[axis] : k_nan;
                     })
        .has_extremes = false; // no extremes: the value can be infinite
  builder.add_channel("area", "m^2", "overlap of one interface of each kind, added", [self](const Snapshot& s) { return self->area(s); });
}

// Adds channels for the change of the overlaps relative to the reference pose.
void add_loss_channels(SystemBuilder& builder, const StepLapFriction& friction, bool has_clearance) {
  const auto* self = &friction;
  builder.add_channel("area_lost", "m^2", "overlap lost, summed over the interfaces that lost some, times their number",
                      [self](const Snapshot& s) { return self->loss(s).area_lost; });
  builder.add_channel("overlap_left", "", "of the corner that has lost most, the share that is left of its overlap",
                      [self](const Snapshot& s) { return self->loss(s).overlap_left; });
  builder.add_channel("slid_share", "", "largest displacement of a corner, of the width of its overlap",
                      [self](const Snapshot& s) { return self->loss(s).slid_share; });
  if (has_clearance)
    builder.add_channel("clearance_left", "m", {"until the sheets of a layer butt", "negative: the limb has closed beyond it"},
                        [self](const Snapshot& s) { return self->loss(s).clearance_left; });
}

// Returns the displacement and the rotation between two poses of the limb, in the axes of the active part.
Vec3 change_of(const StepLapFriction& friction, const Pose& from, const Pose& to) {
  const Vec2 moved = friction.in_part_axes(Vec2(to.x - from.x, to.y - from.y));
  return {moved.x(), moved.y(), to.theta - from.theta};
}

void add_slide_channels(SystemBuilder& builder, const StepLapFriction& friction) {
  const auto* self = &friction;
  const RowSpec* hold = friction.hold;
  const bool is_elastic = friction.is_elastic();
  static constexpr const char* names[] = {"dx", "dy", "theta_acc"};
  const auto pose_by_rows = [hold](const Motion<double>* motion) {
    const auto value = [&](int r) { return evaluate_row<false>(hold[r], motion).value; };
    return Pose{value(0), value(1), value(2)};
  };
  const Pose start = pose_by_rows(&builder.reference(0));
  for (int r = 0; r < 3; ++r) {
    const double sign = r < 2 ? 1.0 : -1.0; // θ_acc is the angle of the active part relative to the limb (23)
    builder.add_channel(names[r], r < 2 ? "m" : "rad",
                        {"slid since the reference pose", r == 0   ? "of the limb, along x of the active part's axes"
                                                          : r == 1 ? "of the limb, along y of the active part's axes"
                                                                   : "of the active part against the limb, counter-clockwise"},
                        [self, pose_by_rows, r, start, sign, is_elastic](const Snapshot& s) {
                          return sign * change_of(*self, start, is_elastic ? self->slid_pose(s) : pose_by_rows(s.motion))[r];
                        });
  }
  builder.add_channel("mode", "", {"what the joint does", "", "1 sticks, 2 slips, 3 has come apart"},
                      [self](const Snapshot& s) { return static_cast<double>(self->phase(s)); });
  if (!is_elastic) return;
  static constexpr const char* strains[] = {"strain_x", "strain_y", "strain_angle"};
  for (int r = 0; r < 3; ++r)
    builder.add_channel(strains[r], r < 2 ? "m" : "rad",
                        {"how far the joint's spring is strained: displacement of the limb's centre of gravity",
                         r == 0   ? "along x of the active part's axes"
                         : r == 1 ? "along y of the active part's axes"
                                  : "positive counter-clockwise"},
                        [self, r](const Snapshot& s) { return change_of(*self, self->slid_pose(s), self->pose_of(s.motion))[r]; });
}

// Returns the interfaces that name this joint. Errors in outlines are reported at the interface.
std::vector<const StepLapInterface*> interfaces_of(const StepLapJoint& joint, const SystemBuilder& builder) {
  std::vector<const StepLapInterface*> found;
  for (const ElementEntry& entry : builder.model().elements) {
    const Element& element = *entry.element;
    if (typeid(element) != typeid(StepLapInterface)) continue; // comparing types is faster than a cast
    const auto& interface = static_cast<const StepLapInterface&>(element);
    if (interface.joint == joint.name) found.push_back(&interface);
  }
  return found;
}

void add_rows(const StepLapJoint& e, SystemBuilder& builder, StepLapFriction& friction) {
  const Vec2 directions[2] = {{1.0, 0.0}, {0.0, 1.0}};
  for (int r = 0; r < 3; ++r) {
    RowSpec& row = friction.hold[r];
    row.a = builder.body(e.limb);
    row.b = builder.body(e.active_part);
    row.kind = r < 2 ? MeasureKind::axis : MeasureKind::angle;
    if (r < 2) row.direction = directions[r];
    row.quantity = "joint";
    row.element = builder.element_index();
    row.base = builder.add_base(evaluate_row<false>(row, &builder.reference(0)).value);
  }
}

BodyData mass_of(const std::string& name, const SystemBuilder& builder) {
  BodyData data;
  const Body* body = builder.model().find_body(name);
  if (body && !body->fixed) {
    data.mass = body->mass;
    data.inertia = body->inertia;
  }
  return data;
}

// Returns the stiffness of the joint in translation, N/m: that of the sheets in shear and in contact in series, 1/(1/k + t/G) per area of
// one interface.
double stiffness_of(const StepLapJoint& e, const StepLapFriction& friction, const Pose& reference) {
  if (e.tangential_stiffness) return *e.tangential_stiffness;
  double compliance = 1.0 / *e.contact_stiffness;
  if (e.sheet_thickness) compliance += *e.sheet_thickness / *e.shear_modulus;
  OverlapWorkspace workspace;
  Region region;
  double area_of_all = 0.0;
  for (const SheetPair& s : friction.sheets()) {
    intersect_exactly(s.yoke, s.limb, reference, workspace, region);
    area_of_all += s.count * area(region);
  }
  return area_of_all / compliance;
}

bool check_elastic(const StepLapJoint& e, SystemBuilder& builder, const StepLapFriction& friction) {
  const auto fails = [&builder](bool is_wrong, const char* message) {
    if (is_wrong) builder.error(message);
    return is_wrong;
  };
  bool is_bad = fails(e.tangential_stiffness && e.contact_stiffness, "give either 'tangential_stiffness' or 'contact_stiffness', not both");
  is_bad |=
      fails(e.sheet_thickness.has_value() != e.shear_modulus.has_value(), "give both 'sheet_thickness' and 'shear_modulus', or neither");
  is_bad |= fails(e.mode == "monitor", "an elastic joint cannot be a monitor: a monitored one is rigid");
  is_bad |= fails(!friction.has_sheets(), "an elastic joint needs step_lap_interface elements, over which its stiffness is spread");
  for (const SheetPair& s : friction.sheets())
    is_bad |= fails(s.kinetic_traction != s.static_traction,
                    "an elastic joint has one friction coefficient: leave out 'kinetic_friction' of its interfaces (the kinetic "
                    "one as 'static_friction' is on the safe side)");
  return !is_bad;
}

bool make_elastic(const StepLapJoint& e, const Pose& reference, SystemBuilder& builder, StepLapFriction& friction) {
  if (!check_elastic(e, builder, friction)) return false;
  auto& group = builder.group<ElasticGripGroup>();
  ElasticGripGroup::ElementData entry;
  entry.a = friction.hold[0].a;
  entry.b = friction.hold[0].b;
  entry.friction = &friction;
  entry.inner = builder.add_inner(group, reference.x);
  builder.add_inner(group, reference.y);
  builder.add_inner(group, reference.theta);
  for (int i = 0; i < 4; ++i) builder.add_inner(group, 0.0);
  group.entries.push_back(entry);
  builder.add_unit(group, ElasticGripGroup::k_event_count);
  friction.make_elastic(friction.spread_stiffness(reference, stiffness_of(e, friction, reference)), entry.inner, group.entries.back().unit);
  return true;
}

// The edges of one corner, as indices of beds in EdgeGroup.
struct EdgeCorner {
  std::vector<int> beds;
  double count = 0.0;
  Vec2 middle = Vec2::Zero(); ///< centre of its first line, axes of the active part
};

// Returns the load of a corner: loads along its adjacent bands are added as if on one line.
EdgeGroup::Bearing bearing_of(const EdgeGroup& group, const EdgeCorner& corner, const Motion<double>* motion) {
  EdgeGroup::Bearing sum;
  for (const int bed : corner.beds) {
    const auto b = group.bearing(bed, motion);
    sum.force += b.force;
    for (int end = 0; end < 2; ++end) sum.load[end] += b.load[end];
  }
  return sum;
}

double largest_load(const EdgeGroup& group, const std::vector<EdgeCorner>& corners, const Motion<double>* motion) {
  double largest = 0.0;
  for (const EdgeCorner& corner : corners) {
    const auto b = bearing_of(group, corner, motion);
    largest = std::max({largest, b.load[0], b.load[1]});
  }
  return largest;
}

void add_edge_channels(const StepLapJoint& e, SystemBuilder& builder, const StepLapFriction& friction, const EdgeGroup& group,
                       const std::vector<EdgeCorner>& corners) {
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const EdgeCorner corner = corners[c];
    const std::string number = "_" + std::to_string(c + 1);
    std::ostringstream at;
    at.precision(4);
    const Vec2 middle = friction.in_part(corner.middle);
    at << "corner about (" << middle.x() << ", " << middle.y() << ") m from the active part's centre of gravity";
    builder.add_channel("edge_force" + number, "N", "with which sheet edges press the limb off the yoke, " + at.str(),
                        [&group, corner](const Snapshot& s) { return bearing_of(group, corner, s.motion).force; });
    for (const int end : {0, 1})
      builder.add_channel("edge_load" + number + (end == 0 ? "_start" : "_end"), "N/m",
                          "line load of sheet edges at one end of the mitre, " + at.str() + "; straight in between",
                          [&group, corner, end](const Snapshot& s) { return bearing_of(group, corner, s.motion).load[end]; });
  }
  builder.add_channel("edge_load", "N/m", "largest line load of sheet edges at any corner",
                      [&group, corners](const Snapshot& s) { return largest_load(group, corners, s.motion); });
  if (e.steel_thickness)
    builder.add_channel("edge_pressure", "Pa", "largest pressure on sheet edges, the line load over the steel's thickness",
                        [&group, corners, thickness = *e.steel_thickness](const Snapshot& s) {
                          return largest_load(group, corners, s.motion) / thickness;
                        });
  if (e.allowed_line_load)
    builder.add_channel(
        "edge_share", "", "largest line load of sheet edges, of the allowed one",
        [&group, corners, allowed = *e.allowed_line_load](const Snapshot& s) { return largest_load(group, corners, s.motion) / allowed; });
}

// Returns the bed of a corner for a line with this clearance: parallel lines of equal clearance close together.
EdgeGroup::ElementData& bed_of(EdgeCorner& corner, const EdgeLine& line, double clearance, const StepLapFriction& friction,
                               SystemBuilder& builder, EdgeGroup& group) {
  constexpr double k_parallel = 1e-9; // rad: rounding error of the directions of parallel lines
  for (const int bed : corner.beds)
    if (EdgeGroup::ElementData& entry = group.entries[bed];
        entry.clearance == clearance && std::abs(cross(entry.lines.front().gap[0].axis, line.off)) < k_parallel)
      return entry;
  EdgeGroup::ElementData entry;
  entry.a = friction.hold[0].a;
  entry.b = friction.hold[0].b;
  entry.clearance = clearance;
  if (corner.beds.empty()) corner.middle = 0.5 * (line.ends[0] + line.ends[1]);
  corner.beds.push_back(static_cast<int>(group.entries.size()));
  group.entries.push_back(entry);
  builder.add_unit(group, EdgeGroup::k_event_count);
  return group.entries.back();
}

bool add_edges(const StepLapJoint& e, const Pose& reference, SystemBuilder& builder, const StepLapFriction& friction) {
  const auto fails = [&builder](const char* message) {
    builder.error(message);
    return false;
  };
  if (!e.edge_stiffness)
    return (!e.allowed_line_load || fails("'allowed_line_load' needs 'edge_stiffness'")) &&
           (!e.steel_thickness || fails("'steel_thickness' needs 'edge_stiffness'"));
  const std::vector<SheetPair>& sheets = friction.sheets();
  const OverlapReference& overlaps = friction.overlaps();
  std::vector<EdgeCorner> corners(overlaps.corner_count());
  for (std::size_t i = 0; i < sheets.size(); ++i)
    if (sheets[i].clearance) corners[overlaps.corner_of(i)].count += sheets[i].count;
  auto& group = builder.group<EdgeGroup>();
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (!sheets[i].clearance) continue;
    const EdgeLine line = find_edge_line(sheets[i], reference);
    if (!line.is_known()) continue; // without an overlap there is no edge line
    EdgeCorner& corner = corners[overlaps.corner_of(i)];
    EdgeGroup::Line own;
    own.stiffness = *e.edge_stiffness * sheets[i].count / corner.count;
    own.length = (line.ends[1] - line.ends[0]).norm();
    for (int end = 0; end < 2; ++end) {
      const Vec2 in_limb = rotated(line.ends[end] - Vec2(reference.x, reference.y), -reference.theta);
      own.gap[end] = {in_limb, line.ends[end] - *sheets[i].clearance * line.off, line.off};
    }
    bed_of(corner, line, *sheets[i].clearance, friction, builder, group).lines.push_back(own);
  }
  corners.erase(std::remove_if(corners.begin(), corners.end(), [](const EdgeCorner& c) { return c.beds.empty(); }), corners.end());
  if (corners.empty()) return fails("'edge_stiffness' needs the 'clearance' of its step_lap_interface elements");
  add_edge_channels(e, builder, friction, group, corners);
  return true;
}

void compile_joint(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const StepLapJoint&>(element);
  if (builder.body(e.limb) == builder.body(e.active_part)) return builder.error("joins a body to itself: name two different bodies");
  const auto interfaces = interfaces_of(e, builder);
  std::vector<SheetPair> sheets;
  try {
    for (const StepLapInterface* i : interfaces) {
      sheets.push_back(make_sheets(*i, e.limb, e.active_part, builder));
      // an infinite traction is reported at the interface, like errors of polygons
      if (!std::isfinite(sheets.back().static_traction)) return;
    }
  } catch (const PolygonError&) {
    return;
  }
  auto friction = std::make_unique<StepLapFriction>(e.name, builder.next_friction(), builder.next_friction_row(), std::move(sheets),
                                                    e.mode == "monitor", e.on_apart == "stop");
  if (const Body* part = builder.model().find_body(e.active_part); part && part->fixed) {
    const Vec3 pose = part->reference_pose();
    friction->part_frame = {pose.x(), pose.y(), pose.z()};
  }
  add_rows(e, builder, *friction);
  const Pose reference = friction->pose_of(&builder.reference(0));
  friction->centre_pressures(reference);
  friction->set_pressure(steady_signal(builder, e.pressure_signal, "pressure_signal"), e.pressure_loss,
                         steady_signal(builder, e.transverse_acceleration, "transverse_acceleration"));
  if (!e.transverse_acceleration.empty() &&
      std::none_of(interfaces.begin(), interfaces.end(), [](const auto* i) { return i->transverse_pressure != 0.0; }))
    return builder.error("'transverse_acceleration' changes nothing: give its step_lap_interface elements a 'transverse_pressure'");
  Patch patch;
  try {
    patch = friction->patch_at(reference, GripLaw::holding);
  } catch (const NumericalFailure&) {
    return builder.error("the pressure of one of its step_lap_interface elements is negative somewhere in the overlap: a smaller "
                         "'pressure_gradient', or more 'pressure'");
  }
  if (friction->has_sheets() && patch.empty())
    return builder.error("its sheets do not overlap in the reference pose: check the polygons and the "
                         "'frame' of its step_lap_interface elements");
  friction->set_scales(reference, std::move(patch), mass_of(e.limb, builder), mass_of(e.active_part, builder));
  if (is_elastic(e) && !make_elastic(e, reference, builder, *friction)) return;
  add_wrench_channels(builder, *friction);
  if (friction->has_sheets()) {
    add_usage_channels(builder, *friction, *interfaces.front());
    // Gravity, m/s², for the weight in a model that shows the limb from above, without gravity in its plane.
    constexpr double k_standard_gravity = 9.80665;
    const double gravity = builder.model().header.gravity.norm();
    add_share_channels(builder, *friction, interfaces, mass_of(e.limb, builder).mass * (gravity > 0.0 ? gravity : k_standard_gravity));
    add_loss_channels(builder, *friction,
                      std::any_of(interfaces.begin(), interfaces.end(), [](const auto* i) { return i->clearance.has_value(); }));
  }
  add_slide_channels(builder, *friction);
  if (!add_edges(e, reference, builder, *friction)) return;
  builder.add_friction(std::move(friction));
}

// Examples: a rigid joint, and one with all optional fields.
constexpr const char* k_example = R"([[signal]]
name = 'press'
kind = 'constant'
value = 1.0
[[element]]
name = 'sheets of it'
kind = 'step_lap_interface'
joint = 'stiff'
yoke = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.2], [-1.0, 0.2]]
limb = [[-0.3, 0.0], [0.3, 0.0], [0.3, 1.0], [-0.3, 1.0]]
pressure = 1e6
static_friction = 0.3
part = 'one packet'
part_share = 0.5
[[element]]
name = 'stiff'
kind = 'step_lap_joint'
limb = 'a'
active_part = 'b'
[[element]]
name = 'sheets below'
kind = 'step_lap_interface'
joint = 'stiff'
yoke = [[-1.0, -2.5], [1.0, -2.5], [1.0, -2.0], [-1.0, -2.0]]
limb = [[-0.3, -2.1], [0.3, -2.1], [0.3, -1.0], [-0.3, -1.0]]
pressure = 1e6
static_friction = 0.3
part = 'another packet'
part_share = 0.5
[[element]]
name = 'soft'
kind = 'step_lap_joint'
limb = 'a'
active_part = 'b'
tangential_stiffness = 1e8
edge_stiffness = 1e9
allowed_line_load = 1e5
pressure_signal = 'press'
[[element]]
name = 'sheets of that'
kind = 'step_lap_interface'
joint = 'soft'
yoke = [[-1.0, -0.5], [1.0, -0.5], [1.0, 0.2], [-1.0, 0.2]]
limb = [[-0.3, 0.0], [0.3, 0.0], [0.3, 1.0], [-0.3, 1.0]]
pressure = 1e6
static_friction = 0.3
clearance = 0.001
)";

// Fields for the elasticity before sliding.
void add_elastic_fields(FieldTable& f) {
  using T = StepLapJoint;
  f.add("tangential_stiffness", &T::tangential_stiffness)
      .in("N/m")
      .positive()
      .doc("of the whole joint in translation, spread evenly over its overlaps: a spring in series with the "
           "friction. Without it "
           "(and contact_stiffness) the joint sticks exactly");
  f.add("contact_stiffness", &T::contact_stiffness)
      .in("N/m^3")
      .positive()
      .doc("the same, of a square metre of one interface: tangential stiffness of two sheets pressed on each other");
  f.add("sheet_thickness", &T::sheet_thickness).in("m").positive().doc("in series with contact_stiffness: sheets in shear");
  f.add("shear_modulus", &T::shear_modulus).in("Pa").positive().doc("of the sheets, with sheet_thickness");
}

// Fields for the contact of sheet edges after a clearance has closed.
void add_edge_fields(FieldTable& f) {
  using T = StepLapJoint;
  f.add("edge_stiffness", &T::edge_stiffness)
      .in("N/m^2")
      .positive()
      .doc("of sheet edges that press on each other once a clearance has closed: line load over depth, of all sheets "
           "at a corner. "
           "Without it sheets pass each other freely, and a closed clearance is only reported");
  f.add("allowed_line_load", &T::allowed_line_load)
      .in("N/m")
      .positive()
      .limit()
      .doc("of all sheets at a corner, along the mitre: beyond it their edges are crushed and the joint is rejected");
  f.add("steel_thickness", &T::steel_thickness)
      .in("m")
      .positive()
      .doc("of all sheets at a corner, over which the line load of their edges is spread: reported as edge_pressure");
}

} // namespace

const ElementKind& step_lap_joint_kind() {
  static const ElementKind kind = [] {
    using T = StepLapJoint;
    ElementKind k;
    k.name = "step_lap_joint";
    k.doc = "A core limb held to the active part by friction between overlapped sheets, which are its "
            "step_lap_interface elements. Sticks exactly while the wrench on the limb is within the limit "
            "surface of the overlap, else slides; without interfaces it holds whatever it takes.";
    FieldTable& f = k.fields;
    f.add("limb", &T::limb).as(FieldType::body).required().doc("the limb");
    f.add("active_part", &T::active_part).as(FieldType::body).required().doc("the part with the yokes");
    f.add("mode", &T::mode).one_of({"slip", "monitor"}).doc("monitor: never slides, but reports the pressure that it would take");
    f.add("on_apart", &T::on_apart)
        .one_of({"stop", "continue"})
        .doc("when no overlap is left: the run ends, or continues without friction");
    add_elastic_fields(f);
    add_edge_fields(f);
    f.add("pressure_signal", &T::pressure_signal).as(FieldType::signal).doc("factor of all its pressures in time, above 0; not given: 1");
    f.add("pressure_loss", &T::pressure_loss).not_negative().at_most(0.99).doc("share of all its pressures that relaxation has taken");
    f.add("transverse_acceleration", &T::transverse_acceleration)
        .as(FieldType::signal)
        .in("m/s^2")
        .doc("across the sheets, out of the plane of motion: changes the pressure of each interface by its "
             "transverse_pressure");
    f.add("least_margin", &T::least_margin)
        .at_least(1.0)
        .limit()
        .doc("smallest margin (capacity over what is in use) that a run must leave: inspect below it");
    f.add("most_slide", &T::most_slide)
        .positive()
        .at_most(1.0)
        .limit()
        .doc("largest permitted displacement of a corner, as a share of the width of its overlap: reject beyond it");
    k.holds<T>();
    k.compile = compile_joint;
    k.example = k_example;
    k.judge = judge_step_lap_joint;
    k.channels_of_trust = trust_of_step_lap_joint;
    return k;
  }();
  return kind;
}

} // namespace steplap
