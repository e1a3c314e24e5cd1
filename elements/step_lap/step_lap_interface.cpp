#include "elements/step_lap/step_lap_interface.h"

#include "elements/step_lap/step_lap_joint.h"
#include "mbd/base/portable_math.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>
#include <vector>

namespace steplap {

namespace {

/// Returns a point of the model file in the axes of `body` about its centre of gravity.
Vec2 in_body(const Vec2& point, bool is_in_body_frame, const std::string& body, const SystemBuilder& builder) {
  Vec2 ground = point;
  const Body* frame = builder.model().find_body(body);
  if (is_in_body_frame && frame) ground = frame->position + rotated(point, frame->angle);
  const Motion<double>& m = builder.reference(builder.body(body));
  return rotated(ground - Vec2(m.x, m.y), -m.theta);
}

/// One of the two sheets as given in the model file.
struct Sheet {
  const char* name;
  const std::vector<Vec2>* outline;
  const std::vector<Vec2>* holes;
  const std::vector<std::vector<Vec2>>* cutouts;
};

Sheet yoke_of(const StepLapInterface& e) { return {"yoke", &e.yoke, &e.yoke_holes, &e.yoke_cutouts}; }
Sheet limb_of(const StepLapInterface& e) { return {"limb", &e.limb, &e.limb_holes, &e.limb_cutouts}; }

bool are_same_bits(const Ring& a, const Ring& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec2)) == 0);
}

bool are_same_bits(const Polygon& a, const Polygon& b) {
  return are_same_bits(a.outer, b.outer) && std::equal(a.holes.begin(), a.holes.end(), b.holes.begin(), b.holes.end(),
                                                       [](const Ring& x, const Ring& y) { return are_same_bits(x, y); });
}

// Returns make_outline(polygon), cached; valid until the next call. Without the cache this takes a quarter of the compilation of a system:
// an interface is compiled twice (for its check and with its joint), and variants of a scene mostly have the same sheets.
const Outline& outline_of(Polygon polygon) {
  struct CachedOutline {
    Polygon polygon;
    Outline outline;
  };
  constexpr std::size_t k_kept = 64;
  thread_local std::vector<CachedOutline> made;
  thread_local std::size_t next = 0;
  const auto known = std::find_if(made.begin(), made.end(), [&](const CachedOutline& m) { return are_same_bits(m.polygon, polygon); });
  if (known != made.end()) return known->outline;
  Outline outline = make_outline(polygon);
  if (made.size() < k_kept) return made.emplace_back(CachedOutline{std::move(polygon), std::move(outline)}).outline;
  CachedOutline& place = made[next];
  next = (next + 1) % k_kept;
  place = {std::move(polygon), std::move(outline)};
  return place.outline;
}

const Outline& make_sheet(const StepLapInterface& e, const Sheet& sheet, const std::string& body, const SystemBuilder& builder) {
  const bool is_in_body_frame = e.frame == "body";
  const auto ring_in_body = [&](const std::vector<Vec2>& points) {
    Ring ring;
    for (const Vec2& p : points) ring.push_back(in_body(p, is_in_body_frame, body, builder));
    return ring;
  };
  Polygon polygon;
  polygon.outer = ring_in_body(*sheet.outline);
  for (const Vec2& p : *sheet.holes)
    polygon.holes.push_back(round_hole(in_body(p, is_in_body_frame, body, builder), e.hole_diameter, e.hole_sides));
  for (const std::vector<Vec2>& cutout : *sheet.cutouts) polygon.holes.push_back(ring_in_body(cutout));
  return outline_of(std::move(polygon));
}

/// Throws PolygonError in which rings have the names of the model's fields, and positions are in its coordinates.
void check_sheet(const StepLapInterface& e, const Sheet& sheet) {
  Polygon polygon{*sheet.outline, {}};
  std::vector<std::string> names;
  const std::string start = std::string("'") + sheet.name;
  for (std::size_t i = 0; i < sheet.holes->size(); ++i) {
    polygon.holes.push_back(round_hole((*sheet.holes)[i], e.hole_diameter, e.hole_sides));
    names.push_back(start + "_holes[" + std::to_string(i) + "]'");
  }
  for (std::size_t i = 0; i < sheet.cutouts->size(); ++i) {
    polygon.holes.push_back((*sheet.cutouts)[i]);
    names.push_back(start + "_cutouts[" + std::to_string(i) + "]'");
  }
  static_cast<void>(repaired(std::move(polygon), names));
}

void compile_interface(const Element& element, SystemBuilder& builder) {
  const auto& e = static_cast<const StepLapInterface&>(element);
  const ElementEntry* entry = builder.element(e.joint);
  const auto* joint = entry ? dynamic_cast<const StepLapJoint*>(entry->element.get()) : nullptr;
  if (!joint) return builder.error("'joint': '" + e.joint + "' is no step_lap_joint");
  if (e.kinetic_friction.value_or(e.static_friction) > e.static_friction)
    return builder.error("'kinetic_friction' must not exceed 'static_friction'");
  if (!std::isfinite(e.count * e.pressure * e.static_friction))
    return builder.error("'count', 'pressure' and 'static_friction' make a traction that is no number: give a pressure as clamps have it");
  if (!(e.yoke_holes.empty() && e.limb_holes.empty()) && !(e.hole_diameter > 0.0))
    return builder.error("has holes: 'hole_diameter' must be more than 0 m");
  if (!e.part.empty() && !(e.part_share > 0.0)) return builder.error("names a 'part': give its 'part_share' of the limb's weight, too");
  if (e.across && !(e.across->norm() > 0.0)) return builder.error("'across' must not be [0, 0]");
  // Sheets are checked one by one, so that the message can name the invalid one.
  for (const bool is_yoke : {true, false}) try {
      const Sheet sheet = is_yoke ? yoke_of(e) : limb_of(e);
      try {
        static_cast<void>(make_sheet(e, sheet, is_yoke ? joint->active_part : joint->limb, builder));
      } catch (const PolygonError&) {
        check_sheet(e, sheet); // throws the error in terms of the model file
        throw;
      }
    } catch (const PolygonError& error) {
      builder.error(std::string(is_yoke ? "'yoke'" : "'limb'") + ": " + error.what());
    }
}

} // namespace

// Radius for an equal area of polygon and circle: n/2 r² sin(2π/n) = π d²/4.
Ring round_hole(const Vec2& centre, double diameter, long sides) {
  const double step = 2.0 * std::numbers::pi / static_cast<double>(sides);
  const double radius = 0.5 * diameter * std::sqrt(step / portable::sin(step));
  Ring ring;
  for (long i = 0; i < sides; ++i) ring.push_back(centre + radius * rotated({1.0, 0.0}, step * static_cast<double>(i)));
  return ring;
}

SheetPair make_sheets(const StepLapInterface& e, const std::string& limb, const std::string& active_part, const SystemBuilder& builder) {
  SheetPair pair;
  pair.yoke = make_sheet(e, yoke_of(e), active_part, builder);
  pair.limb = make_sheet(e, limb_of(e), limb, builder);
  pair.static_traction = e.count * e.pressure * e.static_friction;
  pair.kinetic_traction = e.count * e.pressure * e.kinetic_friction.value_or(e.static_friction);
  // From the axes of `frame` to those of the compiled active part, which for a fixed body are those of the ground.
  const Body* part = builder.model().find_body(active_part);
  const double turn = (e.frame == "body" && part ? part->angle : 0.0) - builder.reference(builder.body(active_part)).theta;
  pair.gradient = rotated(e.pressure_gradient, turn) / e.pressure;
  pair.transverse = e.transverse_pressure / e.pressure;
  pair.count = e.count;
  pair.clearance = e.clearance;
  if (e.across) pair.across = rotated(e.across->normalized(), turn);
  return pair;
}

const ElementKind& step_lap_interface_kind() {
  static const ElementKind kind = [] {
    using T = StepLapInterface;
    ElementKind k;
    k.name = "step_lap_interface";
    k.stage = 1;
    k.doc = "A yoke sheet and a limb sheet that overlap: one kind of interface of a step_lap_joint. "
            "Friction acts where the two polygons overlap at the present relative pose.";
    FieldTable& f = k.fields;
    f.add("joint", &T::joint).as(FieldType::element).required().doc("the step_lap_joint it belongs to");
    f.add("yoke", &T::yoke).in("m").required().doc("corners of the sheet fixed in the active part");
    f.add("limb", &T::limb).in("m").required().doc("corners of the sheet fixed in the limb");
    f.add("frame", &T::frame)
        .one_of({"ground", "body"})
        .doc("corners in ground coordinates of the reference pose, or each in its body's frame");
    f.add("yoke_holes", &T::yoke_holes).in("m").doc("centres of round holes in the yoke sheet");
    f.add("limb_holes", &T::limb_holes).in("m").doc("centres of round holes in the limb sheet");
    f.add("yoke_cutouts", &T::yoke_cutouts).in("m").doc("holes in the yoke sheet of any shape: corners of each, either sense");
    f.add("limb_cutouts", &T::limb_cutouts).in("m").doc("holes in the limb sheet of any shape: corners of each, either sense");
    f.add("hole_diameter", &T::hole_diameter).in("m").not_negative().doc("of all round holes");
    f.add("hole_sides", &T::hole_sides).at_least(3).at_most(360).doc("a round hole is a polygon of the circle's area");
    f.add("pressure", &T::pressure)
        .in("Pa")
        .positive()
        .required()
        .doc("clamping pressure, at the middle of the overlap in the reference pose");
    f.add("pressure_gradient", &T::pressure_gradient)
        .in("Pa/m")
        .doc("by which the pressure grows along x and y of the corners' frame; it may be negative nowhere in the overlap");
    f.add("transverse_pressure", &T::transverse_pressure)
        .in("Pa s^2/m")
        .doc("by which the pressure grows per m/s² of the joint's transverse_acceleration: density × distance of this packet from "
             "the free side of the stack, less what it loses on the other; may be negative");
    f.add("transverse_spread", &T::transverse_spread)
        .in("Pa s^2/m")
        .not_negative()
        .doc("by how much more or less than that the pressure grows at the outermost of its sheets: density × half the depth "
             "of this packet; shows when the first of them come loose");
    f.add("static_friction", &T::static_friction).positive().required().doc("mu_s");
    f.add("kinetic_friction", &T::kinetic_friction).positive().doc("mu_k; default: mu_s");
    f.add("count", &T::count).positive().doc("number of equal interfaces in the stack");
    f.add("part", &T::part).doc("name of the packet of the limb's sheets that it holds, if packets are to be judged one by one");
    f.add("part_share", &T::part_share)
        .not_negative()
        .at_most(1.0)
        .doc("share of the limb's weight that this packet has; needed with part");
    f.add("clearance", &T::clearance)
        .in("m")
        .not_negative()
        .doc("by which the limb may move towards the yoke, across the overlap, before the sheets of a layer butt; not given: "
             "not known, and not looked at");
    f.add("across", &T::across)
        .doc("direction from the yoke to the limb, in which a limb moves away from the yoke; axes "
             "by "
             "'frame'; default: from the middle of one sheet to that of the other");
    k.example = R"([[element]]
name = 'joint'
kind = 'step_lap_joint'
limb = 'a'
active_part = 'b'
[[element]]
name = 'sheets'
kind = 'step_lap_interface'
joint = 'joint'
yoke = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.2], [-0.5, 0.2]]
limb = [[-0.3, 0.0], [0.3, 0.0], [0.3, 1.0], [-0.3, 1.0]]
pressure = 1e6
static_friction = 0.3
)";
    k.holds<T>();
    k.compile = compile_interface;
    return k;
  }();
  return kind;
}

} // namespace steplap
