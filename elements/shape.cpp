#include "elements/shape.h"

#include "elements/step_lap/patch/polygon.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_noticeable = 0.01; // relative difference that is reported; dimensions on drawings are hardly more accurate

// Moments of an area: ∫ dA, ∫ p dA / ∫ dA, ∫ |p − centre|² dA.
struct Area {
  double size = 0.0;
  Vec2 centre = Vec2::Zero();
  double polar = 0.0;
};

double polar_about(const Area& area, const Vec2& point) { return area.polar + area.size * (area.centre - point).squaredNorm(); }

Area disc(const Vec2& centre, double diameter) {
  const double size = 0.25 * std::numbers::pi * diameter * diameter;
  return {size, centre, size * diameter * diameter / 8.0};
}

Area ring(const Ring& corners) {
  const Vec2 origin = corners.front();
  double twice = 0.0, polar = 0.0;
  Vec2 first = Vec2::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 p = corners[i] - origin, q = corners[(i + 1) % corners.size()] - origin;
    const double c = p.x() * q.y() - p.y() * q.x();
    twice += c;
    first += c * (p + q);
    polar += c * (p.squaredNorm() + p.dot(q) + q.squaredNorm());
  }
  const double size = 0.5 * twice;
  const Vec2 centre = first / (6.0 * size);
  return {std::abs(size), origin + centre, std::abs(polar / 12.0) - std::abs(size) * centre.squaredNorm()};
}

// Returns a regular polygon for the check whether a hole is inside the outline, with corners on the circle, or (`is_around`) slightly
// outside.
Ring circle(const Vec2& centre, double diameter, bool is_around) {
  constexpr int k_sides = 90;
  const double half = std::numbers::pi / k_sides, radius = 0.5 * diameter / (is_around ? portable::cos(half) : 1.0);
  Ring corners;
  for (int k = 0; k < k_sides; ++k) {
    const portable::SinCos at = portable::sin_cos(2.0 * half * k);
    corners.emplace_back(centre + radius * Vec2(at.cos, at.sin));
  }
  return corners;
}

[[noreturn]] void fail(const BodyShape& shape, const std::string& field, const std::string& message) {
  throw ModelError(shape.place(field), "shape '" + shape.name + "': " + message);
}

void check_fields(const BodyShape& shape) {
  if (shape.diameter && !shape.outline.empty()) fail(shape, "diameter", "gives both 'outline' and 'diameter': give one of them");
  if (!shape.places.empty() && shape.places.count("centre") > 0 && !shape.diameter) fail(shape, "centre", "'centre' goes with 'diameter'");
  const std::size_t centres = shape.hole_centres.size(), diameters = shape.hole_diameters.size();
  if (centres != diameters && diameters != 1)
    fail(shape, "hole_diameters",
         "has " + counted(centres, "hole centre", "hole centres") + " and " + counted(diameters, "diameter", "diameters") +
             ": give one diameter for all, or one for each");
  if (centres == 0 && diameters > 0) fail(shape, "hole_diameters", "'hole_diameters' go with 'hole_centres'");
  if (shape.density.has_value() != shape.thickness.has_value())
    fail(shape, shape.density ? "density" : "thickness", "'density' and 'thickness' go together; a mass per area is 'area_density'");
  if (shape.density && shape.area_density) fail(shape, "area_density", "gives both 'density' and 'area_density': give one of them");
  if (shape.mass && (shape.density || shape.area_density)) fail(shape, "mass", "gives both 'mass' and a density: give one of them");
}

// Returns the moments of a shape's area. Throws ModelError if it has none.
Area area_of(const BodyShape& shape, const Body& body) {
  check_fields(shape);
  const std::vector<Vec2>& outline = shape.outline.empty() ? body.outline : shape.outline;
  if (!shape.diameter && outline.empty())
    fail(shape, "body", "needs 'outline' or 'diameter', since body '" + body.name + "' has no outline");
  Polygon polygon;
  polygon.outer = shape.diameter ? circle(shape.centre, *shape.diameter, true) : outline;
  polygon.holes = shape.holes;
  const auto diameter = [&](std::size_t k) {
    return shape.hole_diameters.size() == 1 ? shape.hole_diameters.front() : shape.hole_diameters[k];
  };
  std::vector<std::string> names;
  for (std::size_t k = 0; k < shape.holes.size(); ++k) names.push_back("hole " + std::to_string(k + 1));
  for (std::size_t k = 0; k < shape.hole_centres.size(); ++k) {
    polygon.holes.push_back(circle(shape.hole_centres[k], diameter(k), false));
    names.push_back("round hole " + std::to_string(k + 1));
  }
  try {
    polygon = repaired(std::move(polygon), names);
  } catch (const PolygonError& error) {
    fail(shape,
         shape.holes.empty() && shape.hole_centres.empty() ? "outline"
         : shape.holes.empty()                             ? "hole_centres"
                                                           : "holes",
         error.what());
  }
  const Area whole = shape.diameter ? disc(shape.centre, *shape.diameter) : ring(polygon.outer);
  std::vector<Area> holes;
  for (std::size_t k = 0; k < shape.holes.size(); ++k) holes.push_back(ring(polygon.holes[k]));
  for (std::size_t k = 0; k < shape.hole_centres.size(); ++k) holes.push_back(disc(shape.hole_centres[k], diameter(k)));
  Area rest = whole;
  Vec2 lever = whole.size * whole.centre;
  for (const Area& hole : holes) {
    rest.size -= hole.size;
    lever -= hole.size * hole.centre;
  }
  rest.centre = lever / rest.size;
  rest.polar = polar_about(whole, rest.centre);
  for (const Area& hole : holes) rest.polar -= polar_about(hole, rest.centre);
  return rest;
}

std::vector<const BodyShape*> shapes_of(const Model& model, const std::string& body) {
  std::vector<const BodyShape*> found;
  for (const TableEntry& entry : model.tables)
    if (const auto* shape = dynamic_cast<const BodyShape*>(entry.table.get()); shape && shape->body == body) found.push_back(shape);
  return found;
}

double mass_of(const BodyShape& shape, const Area& area, double given_mass, bool is_only_one) {
  if (shape.density) return *shape.density * *shape.thickness * area.size;
  if (shape.area_density) return *shape.area_density * area.size;
  if (shape.mass) return *shape.mass;
  if (!is_only_one)
    fail(shape, "body", "needs 'mass', 'area_density' or 'density' with 'thickness', as every shape of a body that has several");
  if (!(given_mass > 0.0))
    fail(shape, "body", "needs 'mass', 'area_density' or 'density' with 'thickness', since body '" + shape.body + "' has no mass either");
  return given_mass;
}

std::string unlike(const Body& body, const char* field, double given, double made, const char* unit) {
  return "'" + std::string(field) + "' of body '" + body.name + "', " + rounded_text(given) + " " + unit +
         ", contradicts its shape, which makes it " + rounded_text(made) + " " + unit + ": leave '" + field +
         "' out to take it from the shape";
}

std::string point_text(const Vec2& p) { return "[" + rounded_text(p.x()) + ", " + rounded_text(p.y()) + "] m"; }

void apply_shape(const BodyShape& shape, Model& model) {
  const auto found = std::find_if(model.bodies.begin(), model.bodies.end(), [&](const Body& body) { return body.name == shape.body; });
  if (found == model.bodies.end()) fail(shape, "body", "the ground has no mass: name a body");
  Body& body = *found;
  if (shapes_of(model, shape.body).front()->name != shape.name) return; // the first shape of a body applies all of them
  const std::optional<MassOfShapes> made = mass_of_shapes(model, body, body.mass);
  const double mass = body.mass > 0.0 ? body.mass : made->mass;
  if (body.mass == 0.0) body.mass = mass;
  if (body.inertia == 0.0) body.inertia = made->inertia * mass / made->mass;
  if (body.cg == Vec2(Vec2::Zero())) body.cg = made->centre;
  if (body.outline.empty()) body.outline = shape.diameter ? circle(shape.centre, *shape.diameter, false) : shape.outline;
}

} // namespace

std::optional<MassOfShapes> mass_of_shapes(const Model& model, const Body& body, double given_mass) {
  const std::vector<const BodyShape*> shapes = shapes_of(model, body.name);
  if (shapes.empty()) return std::nullopt;
  std::vector<Area> areas;
  std::vector<double> masses;
  MassOfShapes sum;
  for (const BodyShape* shape : shapes) {
    areas.push_back(area_of(*shape, body));
    masses.push_back(mass_of(*shape, areas.back(), given_mass, shapes.size() == 1));
    sum.mass += masses.back();
    sum.centre += masses.back() * areas.back().centre;
  }
  sum.centre /= sum.mass;
  for (std::size_t k = 0; k < areas.size(); ++k) sum.inertia += masses[k] / areas[k].size * polar_about(areas[k], sum.centre);
  return sum;
}

std::vector<ShapeRemark> contradicted_shapes(const Model& model) {
  std::vector<ShapeRemark> remarks;
  for (const Body& body : model.bodies) {
    const std::optional<MassOfShapes> made = mass_of_shapes(model, body, body.mass);
    if (!made || body.fixed) continue;
    if (std::abs(body.mass - made->mass) > k_noticeable * made->mass)
      remarks.push_back({body.where, unlike(body, "mass", body.mass, made->mass, "kg")});
    const double inertia = made->inertia * body.mass / made->mass;
    if (std::abs(body.inertia - inertia) > k_noticeable * inertia)
      remarks.push_back({body.where, unlike(body, "inertia", body.inertia, inertia, "kg m²")});
    const double size = std::sqrt(made->inertia / made->mass); // radius of gyration, m
    if ((body.cg - made->centre).norm() > k_noticeable * size)
      remarks.push_back({body.where, "'cg' of body '" + body.name + "', " + point_text(body.cg) +
                                         ", contradicts its shape, whose centre is " + point_text(made->centre) +
                                         ": leave 'cg' out to take it from the shape"});
  }
  return remarks;
}

const TableKind& shape_kind() {
  static const TableKind kind = [] {
    using T = BodyShape;
    TableKind k;
    k.name = "shape";
    k.doc = "An area of a body that determines its missing properties: mass, centre of gravity, inertia, outline. An "
            "outline or a disc, with holes; "
            "several shapes of a body add up.";
    FieldTable& f = k.fields;
    f.add("body", &T::body).as(FieldType::body).required().doc("the body that it is of");
    f.add("outline", &T::outline).in("m").doc("corners in the body's frame, either sense; default: the body's outline");
    f.add("centre", &T::centre).in("m").doc("of a disc, in the body's frame");
    f.add("diameter", &T::diameter).in("m").positive().doc("of a disc, instead of an outline");
    f.add("holes", &T::holes).in("m").doc("corners of each hole, either sense");
    f.add("hole_centres", &T::hole_centres).in("m").doc("centres of round holes");
    f.add("hole_diameters", &T::hole_diameters).in("m").positive().doc("of round holes: one for all, or one for each");
    f.add("density", &T::density).in("kg/m^3").positive().doc("of the material, with 'thickness'");
    f.add("thickness", &T::thickness).in("m").positive().doc("across the plane of the model");
    f.add("area_density", &T::area_density).in("kg/m^2").positive().doc("mass per area, instead of density and thickness");
    f.add("mass", &T::mass)
        .in("kg")
        .positive()
        .doc("of the shape with its holes taken off, instead of a density; default: the body's mass, if this is its only shape");
    k.holds<T>();
    k.reads_elements = false;
    k.apply = [](const Element& table, Model& model) { apply_shape(static_cast<const T&>(table), model); };
    return k;
  }();
  return kind;
}

} // namespace steplap
