#include "elements/views/symbols.h"

#include "elements/machinery/lift_curve.h"
#include "elements/spring_laws.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace steplap {

namespace {

// --- springs, rods, ropes and drives --------------------------------------------------------------

std::string style_of_spring(const Sketch& s) {
  const bool has_spring =
      s.number("stiffness") > 0.0 || s.is_given("frequency") || !s.text("material").empty() || !s.points("force_table").empty();
  const bool has_damper = s.number("damping") > 0.0 || s.is_given("damping_ratio") || !s.points("damping_table").empty();
  return has_damper ? (has_spring ? "both" : "damper") : "";
}

void spring_damper(Sketch& s) { s.draw({"spring", style_of_spring(s), "force", s.places(), s.direction("axis"), {}}); }

void rotational_spring_damper(Sketch& s) { s.draw({"arc", "spring", "couple", s.places(), {}, {}}); }

void maxwell(Sketch& s) { s.draw({"spring", "both", "force", s.places(), s.direction("axis"), {}}); }

void bushing(Sketch& s) { s.draw({"bushing", "", "", s.places(), {}, {}}); }

void buffer(Sketch& s) { s.draw({"spring", "both", "force", s.places(), s.direction("axis"), {}}); }

void tie(Sketch& s) { s.draw({"spring", "tie", "force", s.places(), s.direction("axis"), {}}); }

void rope(Sketch& s) {
  Shape shape{"rope", "", "tension", {}, {}, {}};
  if (const auto a = s.place("a")) shape.at.push_back(*a);
  for (const std::string& marker : s.texts("over")) shape.at.push_back(s.place_of(marker));
  if (const auto b = s.place("b")) shape.at.push_back(*b);
  for (const MarkerPlace& place : shape.at) s.note_place(place);
  s.draw(std::move(shape));
}

void wound_rope(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  const double radius_a = s.number("radius_a"), radius_b = s.number("radius_b");
  if (radius_a != 0.0) s.circle(*a, std::abs(radius_a));
  if (radius_b != 0.0) s.circle(*b, std::abs(radius_b));
  s.draw({"rope", "", "tension", {*a, *b}, {}, {radius_a, radius_b}});
}

// Draws a rope; its end on a drum is omitted, because the drum is drawn.
void band(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b"), drum = s.place("drum");
  if (!a || !b || !drum) return;
  const double radius = s.number("radius");
  s.circle(*drum, std::abs(radius));
  s.draw({"rope", "", "tension_a", {*drum, *a}, {}, {radius, 0.0}});
  s.draw({"rope", "", "tension_b", {*drum, *b}, {}, {-radius, 0.0}});
}

void belt(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  const double near = s.number("radius_a"), far = s.is("crossed") ? s.number("radius_b") : -s.number("radius_b");
  s.circle(*a, near);
  s.circle(*b, std::abs(far));
  s.draw({"rope", "", "tension_1", {*a, *b}, {}, {near, far}});
  s.draw({"rope", "", "tension_2", {*a, *b}, {}, {-near, -far}});
}

void load(Sketch& s) {
  const auto force = s.vector("force");
  const bool has_force = (force && force->norm() > 0.0) || s.is_given("force_x") || s.is_given("force_y");
  if (has_force) s.draw({"arrow", "load", "force_x", s.places(), {}, {}});
  if (s.number("couple") != 0.0 || s.is_given("torque")) s.draw({"arc", "couple", "torque", s.places(), {}, {}});
}

// --- contacts -------------------------------------------------------------------------------------

void unilateral_contact(Sketch& s) {
  Shape& shape = s.draw({"contact", "", "force", s.places(), s.direction("normal"), {}});
  if (const auto ends = s.vector("ends")) shape.sizes = {ends->x(), ends->y()};
}

void polygon_contact(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  s.polygon(*a, s.points("outline_a"));
  s.polygon(*b, s.points("outline_b"));
  Shape shape{"faces", "", "force", {}, s.direction("normal"), {}};
  if (!shape.direction && b->body == "ground" && s.points("outline_b").empty()) shape.direction = b->turned(Vec2(0.0, 1.0));
  for (const Vec2& corner : s.points("outline_a")) shape.at.push_back({a->body, a->in_body(corner), a->angle});
  if (shape.at.empty()) shape.at.push_back(*a);
  shape.at.push_back(*b);
  s.draw(std::move(shape));
  if (s.number("static_friction") > 0.0) s.draw({"friction", "", "friction", {}, {}, {}});
}

void circle_contact(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  const bool is_inside = s.is("inside");
  if (s.number("radius_a") > 0.0) s.circle(*a, s.number("radius_a"));
  if (s.number("radius_b") > 0.0) s.circle(*b, s.number("radius_b"), is_inside);
  s.draw({"touch", "", "force", {*a, *b}, {}, {s.number("radius_a"), s.number("radius_b"), is_inside ? 1.0 : 0.0}});
}

void segment_contact(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  const auto from = s.vector("from"), to = s.vector("to");
  if (!a || !b || !from || !to) return;
  if (s.number("radius") > 0.0) s.circle(*a, s.number("radius"));
  s.segment(*b, *from, *to, s.number("thickness"));
  const Vec2 first = b->in_body(*from), last = b->in_body(*to);
  s.draw({"edge_touch", "", "force", {*a, *b}, {}, {s.number("radius"), first.x(), first.y(), last.x(), last.y(), s.number("thickness")}});
}

// Draws a flat road as a line that extends beyond any picture. The road is not part of the body's geometry.
void flat_road(Sketch& s, const MarkerPlace& a, const MarkerPlace& b, double radius) {
  constexpr double k_beyond = 1e3;
  const Vec2 first = b.in_body({-k_beyond * radius, 0.0}), last = b.in_body({k_beyond * radius, 0.0});
  s.draw({"edge_touch", "flat", "force", {a, b}, {}, {radius, first.x(), first.y(), last.x(), last.y(), 0.0}});
}

void tyre(Sketch& s) {
  constexpr int k_parts = 4, k_most_points = 2000; // number of line segments per piece of a curve; largest number of all
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  const double radius = s.number("radius");
  s.circle(*a, radius);
  const std::vector<Vec2> points = s.points("road");
  if (points.size() < 2) return flat_road(s, *a, *b, radius);
  const SmoothCurve curve(points);
  const int parts = points.size() < k_most_points ? k_parts : 1;
  std::vector<double> sizes{radius};
  Vec2 before = points.front();
  for (std::size_t i = 1; i < points.size(); ++i)
    for (int k = 1; k <= parts; ++k) {
      const double x = points[i - 1].x() + (points[i].x() - points[i - 1].x()) * k / parts;
      const Vec2 here(x, curve.value(x));
      s.segment(*b, before, here, 0.0);
      if (sizes.size() == 1) sizes.insert(sizes.end(), {b->in_body(before).x(), b->in_body(before).y()});
      sizes.insert(sizes.end(), {b->in_body(here).x(), b->in_body(here).y()});
      if (sizes.size() == 5) sizes.push_back(0.0); // thickness of the segment
      before = here;
    }
  s.draw({"edge_touch", "", "force", {*a, *b}, {}, std::move(sizes)});
}

void friction(Sketch& s) { s.draw({"friction", "", "friction", {}, {}, {}}); }

// --- joints ---------------------------------------------------------------------------------------

void pin(Sketch& s) { s.draw({"pin", "", "", s.places(), {}, {}}); }
void weld(Sketch& s) { s.draw({"weld", "", "", s.places(), {}, {}}); }
void rod(Sketch& s) { s.draw({"rod", "", "", s.places(), {}, {}}); }
void skate(Sketch& s) {
  const auto a = s.place("a");
  const auto axis = s.vector("axis");
  if (a && axis && axis->norm() > 0.0) s.draw({"rail", "skate", "", {*a}, a->turned(axis->normalized()), {}});
}
void rail(Sketch& s) { s.draw({"rail", "", "", s.places(), s.direction("axis"), {}}); }

void gear(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  if (!a || !b) return;
  s.circle(*a, s.number("radius_a"));
  s.circle(*b, s.number("radius_b"), s.is("inside"));
  s.draw({"touch", "gear", "", {*a, *b}, {}, {s.number("radius_a"), s.number("radius_b"), s.is("inside") ? 1.0 : 0.0}});
}

// Returns the outline of a cam that lifts a pointed follower according to the points of the curve: the positions of the follower's tip
// relative to the rotating cam. Returns nothing if the outline would pass through the cam's axis, for example if the follower's marker is
// not at its tip.
std::vector<Vec2> outline_of_cam(const Sketch& s, const MarkerPlace& follower, const MarkerPlace& frame, const MarkerPlace& cam) {
  constexpr int k_corners = 180;
  const std::vector<Vec2> points = s.points("lift");
  const auto axis = s.vector("axis");
  if (points.size() < 3 || !LiftCurve::is_whole_turn(points) || points.back().y() != points.front().y() || !axis || !(axis->norm() > 0.0))
    return {};
  const LiftCurve curve(points);
  const Vec2 along = rotated(axis->normalized(), frame.axes), from_axis = follower.at - cam.at;
  const double start = s.number("start_angle"), now = curve.at(start).value + s.number("gap");
  std::vector<Vec2> corners;
  double turned = 0.0; // twice the signed area of the outline; its sign shows whether the axis is inside
  for (int i = 0; i < k_corners; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / k_corners;
    const Vec2 place = from_axis + along * (curve.at(start + turn).value - now);
    if (!(place.dot(along) > 0.0)) return {};
    corners.push_back(rotated(place, -turn - cam.axes));
  }
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 &one = corners[i], &next = corners[(i + 1) % corners.size()];
    turned += one.x() * next.y() - one.y() * next.x();
  }
  if (turned < 0.0) std::reverse(corners.begin(), corners.end());
  return corners;
}

// Draws the cam, with an arrow for the force at the position where the follower is lifted.
void cam(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b"), turning = s.place("cam");
  if (!a || !b) return;
  if (turning) s.polygon(*turning, outline_of_cam(s, *a, *b, *turning));
  s.draw({"arrow", "drive", "force", {*a, *b}, s.direction("axis"), {}});
}
void freewheel(Sketch& s) { s.draw({"arc", "brake", "couple", s.places(), {}, {}}); }
// Draws the pitch circles of two wheels on separate axles. Other gears are not drawn, because they may be complete gearboxes.
void lossy_gear(Sketch& s) {
  const auto a = s.place("a"), b = s.place("b");
  const double ratio = s.number("ratio"), apart = a && b ? (a->at - b->at).norm() : 0.0;
  if (apart > 0.0 && ratio < 0.0) {
    const double radius_a = apart / (1.0 - ratio), radius_b = apart - radius_a;
    s.circle(*a, radius_a);
    s.circle(*b, radius_b);
    s.draw({"touch", "gear", "", {*a, *b}, {}, {radius_a, radius_b, 0.0}});
  }
  s.draw({"arc", "drive", "couple", s.places(), {}, {}});
}

void rack(Sketch& s) {
  const auto a = s.place("a");
  if (a) s.circle(*a, s.number("radius"));
  rail(s);
}

// --- driven, limited and braked coordinates -------------------------------------------------------

void coordinate(Sketch& s, const std::string& style, const std::string& along, const std::string& about) {
  const std::string which = s.text("coordinate");
  if (which == "angle") s.draw({"arc", style, about, s.places(), {}, {}});
  else if (which == "distance") s.draw({"spring", style == "limit" ? "tie" : "cylinder", along, s.places(), {}, {}});
  else if (const auto b = s.place("b"))
    s.draw({style == "limit" || style == "brake" ? "rail" : "arrow",
            style,
            along,
            s.places(),
            b->turned(which == "y" ? Vec2(0.0, 1.0) : Vec2(1.0, 0.0)),
            {}});
}

void motor(Sketch& s) { coordinate(s, "motor", "force", "couple"); }
void drive(Sketch& s) { coordinate(s, "drive", "reaction", "reaction"); }
// Draws stops at their positions, measured from the reference pose, or for a distance at its absolute value. A side that is not limited
// gets no stop.
void limit(Sketch& s) {
  coordinate(s, "limit", "force", "couple");
  s.size_last({s.given_number("lower").value_or(-HUGE_VAL), s.given_number("upper").value_or(HUGE_VAL)});
}
void formula_force(Sketch& s) {
  const std::string which = s.text("coordinate");
  const auto a = s.place("a");
  if (which.starts_with("own_") && a)
    s.draw({"arrow", "motor", "force", s.places(), a->turned(which == "own_y" ? Vec2(0.0, 1.0) : Vec2(1.0, 0.0)), {}});
  else coordinate(s, "motor", "force", "couple");
}
void brake(Sketch& s) { coordinate(s, "brake", "friction", "friction"); }

// --- the table ------------------------------------------------------------------------------------

void nothing(Sketch&) {}
void step_lap_joint(Sketch& s) { s.draw({"joint", "", "", {}, {}, {}}); }

} // namespace

Symbol symbol_of(const std::string& kind) {
  static const std::map<std::string, Symbol> symbols{{"spring_damper", spring_damper},
                                                     {"rotational_spring_damper", rotational_spring_damper},
                                                     {"bushing", bushing},
                                                     {"bearing", pin},
                                                     {"maxwell", maxwell},
                                                     {"buffer", buffer},
                                                     {"tie", tie},
                                                     {"rope", rope},
                                                     {"wound_rope", wound_rope},
                                                     {"band", band},
                                                     {"belt", belt},
                                                     {"load", load},
                                                     {"beam_part", nothing},
                                                     {"unilateral_contact", unilateral_contact},
                                                     {"polygon_contact", polygon_contact},
                                                     {"circle_contact", circle_contact},
                                                     {"segment_contact", segment_contact},
                                                     {"tyre", tyre},
                                                     {"coulomb_stick", friction},
                                                     {"rolling_resistance", friction},
                                                     {"step_lap_joint", step_lap_joint},
                                                     {"step_lap_interface", nothing},
                                                     {"revolute", pin},
                                                     {"prismatic", rail},
                                                     {"weld", weld},
                                                     {"distance", rod},
                                                     {"point_on_line", rail},
                                                     {"skate", skate},
                                                     {"gear", gear},
                                                     {"rack", rack},
                                                     {"cam", cam},
                                                     {"freewheel", freewheel},
                                                     {"lossy_gear", lossy_gear},
                                                     {"prescribed_motion", drive},
                                                     {"motor", motor},
                                                     {"limit", limit},
                                                     {"joint_friction", brake},
                                                     {"force", formula_force},
                                                     {"state", nothing}};
  const auto found = symbols.find(kind);
  return found == symbols.end() ? nullptr : found->second;
}

} // namespace steplap
