// Bodies in even rotation and even flight touch what they pass, however long the steps are that the motion alone would allow. Random scenes
// of each kind of element with an event function have a first event that is known in closed form.
#include "elements/machinery/lift_curve.h"
#include "mbd/system/turn_table.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <stdexcept>

using namespace steplap;
using namespace steplap::testing;

namespace {

using random::RandomNumber;

constexpr double k_turn = 2.0 * std::numbers::pi;

std::string digits(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
std::string point(double x, double y) { return "[" + digits(x) + ", " + digits(y) + "]"; }
std::string metres(double x) { return "'" + digits(x) + " m'"; }

/// A scene, which element's first event counts, and when that is.
struct Passing {
  std::string text, element = "it";
  double first = std::numeric_limits<double>::infinity(); ///< s
  double off = 0.0;                                       ///< s, of the first event at most
  double end = 1.0;                                       ///< s
};

/// An arm of length r that turns evenly about the origin.
struct Arm {
  double r = 1.0, rate = 1.0, start = 0.0; ///< m, rad/s, rad
  double half = 0.1;                       ///< rad: half of the angle over which it touches, about `at`
  double at = 0.0;

  [[nodiscard]] std::string text() const {
    return k_no_gravity + body("arm", "mass = 1.0; inertia = 1.0; angle = " + digits(start) + "; angular_velocity = " + digits(rate)) +
           element("revolute", "pin", "a = 'arm'");
  }
  [[nodiscard]] std::string tip() const { return "{ body = 'arm', point = " + point(r, 0.0) + " }"; }
  [[nodiscard]] double angle_at_start() const { return start - at; }
  /// s: when it comes to `half` before or behind `at`, as it turns.
  [[nodiscard]] double first_touch() const {
    const double left = rate > 0.0 ? -half - angle_at_start() : angle_at_start() - half;
    return (left - k_turn * std::floor(left / k_turn)) / std::abs(rate);
  }
  /// A place at a distance from the origin, in the direction of `at` or turned from that.
  [[nodiscard]] std::string place(double distance, double turned = 0.0) const {
    return point(distance * std::cos(at + turned), distance * std::sin(at + turned));
  }
};

/// It begins outside of the angle over which it touches.
Arm random_arm(RandomNumber& own) {
  Arm arm;
  arm.r = own.between(0.3, 3.0);
  arm.rate = own.decades(0.0, 2.477) * (own.chance(0.5) ? 1.0 : -1.0);
  arm.half = own.decades(-4.0, -0.7);
  arm.at = own.between(-3.0, 3.0);
  arm.start = arm.at + own.between(arm.half + 0.05, k_turn - arm.half - 0.05);
  return arm;
}

const std::vector<std::string>& kinds() {
  static const std::vector<std::string> all{
      "circle",         "ring",        "segment", "line",  "face with ends",  "polygon", "tie", "rope", "inextensible rope",
      "distance limit", "place limit", "gap",     "place", "place by formula"};
  return all;
}

// Writes the element that the end of the arm touches. `slope` becomes the derivative of its gap by the arm's angle at the first touch, m;
// 1 if the gap is an angle.
std::string touched(const std::string& kind, const Arm& arm, double& slope) {
  const double half = arm.half, r = arm.r, depth = r * std::cos(half);
  const double far = 1.7 * r, taut = std::sqrt(r * r + far * far + 2.0 * r * far * std::cos(half)); // of a point opposite to `at`
  const double now = std::sqrt(r * r + far * far + 2.0 * r * far * std::cos(arm.angle_at_start()));
  const std::string ends = "a = " + arm.tip() + "; b = { body = 'ground', at = " + arm.place(far, std::numbers::pi) + " }; ";
  const std::string inwards = "normal = " + arm.place(-1.0) + "; b = { body = 'ground', at = " + arm.place(depth) + " }; ";
  const auto by_chord = [&](double chord, double distance) { slope = r * distance * std::sin(half) / chord; };
  const std::string stiff = "stiffness = 1e6";
  if (kind == "circle") {
    const double distance = 1.001 * r, radius = std::sqrt(r * r + distance * distance - 2.0 * r * distance * std::cos(half));
    by_chord(radius, distance);
    return element("circle_contact", "it",
                   "a = " + arm.tip() + "; b = { body = 'ground', at = " + arm.place(distance) + " }; radius_b = " + digits(radius) + "; " +
                       stiff);
  }
  if (kind == "ring") {
    by_chord(taut, far);
    return element("circle_contact", "it", ends + "inside = true; radius_b = " + digits(taut) + "; " + stiff);
  }
  if (kind == "segment") {
    slope = r * std::cos(half);
    return element("segment_contact", "it",
                   "a = " + arm.tip() + "; from = " + arm.place(0.8 * r) + "; to = " + arm.place(1.2 * r) +
                       "; thickness = " + digits(2.0 * r * std::sin(half)) + "; " + stiff);
  }
  slope = r * std::sin(half);
  if (kind == "line") return element("unilateral_contact", "it", "a = " + arm.tip() + "; " + inwards + stiff);
  if (kind == "face with ends")
    return element("unilateral_contact", "it", "a = " + arm.tip() + "; " + inwards + "ends = " + point(-r, r) + "; " + stiff);
  if (kind == "polygon")
    return element("polygon_contact", "it",
                   "a = 'arm'; outline_a = [" + point(r, 0.0) + ", " + point(0.0, 1e-3 * r) + ", " + point(-0.1 * r, 0.0) + ", " +
                       point(0.0, -1e-3 * r) + "]; " + inwards + stiff);
  if (kind == "place limit") // along x: `at` is zero
    return element("limit", "it",
                   "a = " + arm.tip() + "; coordinate = 'x'; upper = " + digits(depth - r * std::cos(arm.start)) + "; " + stiff);
  if (kind == "place")
    return "[[marker]]\nname = 'tip'\nbody = 'arm'\npoint = " + point(r, 0.0) + "\n[[action]]\nname = 'it'\nwhen = \"tip.x > " +
           metres(depth) + "\"\ndo = ['stop']\n";
  if (kind == "place by formula") {
    const double radius = 2.0 * r * std::sin(0.5 * half);
    slope = r * std::cos(0.5 * half);
    return "[[marker]]\nname = 'tip'\nbody = 'arm'\npoint = " + point(r, 0.0) + "\n[[action]]\nname = 'it'\nwhen = \"hypot(tip.x - " +
           metres(r) + ", tip.y) < " + metres(radius) + "\"\ndo = ['stop']\n";
  }
  by_chord(taut, far);
  if (kind == "tie") return element("tie", "it", ends + "slack = " + digits(taut - now) + "; stiffness = 1e6");
  if (kind == "rope") return element("rope", "it", ends + "length = " + digits(taut) + "; stiffness = 1e6");
  if (kind == "inextensible rope") return element("rope", "it", ends + "length = " + digits(taut) + "; inextensible = true");
  if (kind == "distance limit") return element("limit", "it", ends + "coordinate = 'distance'; upper = " + digits(taut) + "; " + stiff);
  if (kind == "gap") return element("spring_damper", "it", ends + "free_length = 0.0; gap = " + digits(2.0 * taut) + "; " + stiff);
  throw std::invalid_argument(kind);
}

Passing random_passing(const std::string& kind, RandomNumber& own) {
  Arm arm = random_arm(own);
  if (kind == "place limit" || kind == "place" || kind == "place by formula") { // of x
    arm.start -= arm.at;
    arm.at = 0.0;
  }
  double slope = 1.0;
  Passing passing;
  passing.text = arm.text() + touched(kind, arm, slope);
  passing.first = arm.first_touch();
  passing.end = k_turn * own.decades(0.0, 2.0) / std::abs(arm.rate);
  passing.end = std::max(passing.end, 1.05 * passing.first);
  // Rounding of a position is some 1e-15 of the arm; divided by the slope it is an error of the angle. An inextensible rope is caught
  // 1e-11 of its length beyond its end (docs/explanation/theory.md).
  const double caught = kind == "inextensible rope" ? 1e-10 * arm.r : 0.0;
  passing.off = (1e-9 + (1e-13 * arm.r + caught) / slope) / std::abs(arm.rate);
  return passing;
}

// A lobe on an even cam, as wide as said, that lifts a follower which stands `gap` above it.
Passing random_cam(RandomNumber& own) {
  const double rate = own.decades(0.0, 2.477), lobe = own.between(0.17, 1.6), top = own.between(1.0, 5.0), height = own.between(1e-3, 0.02);
  const double start = own.between(0.0, top - 0.5 * lobe - 0.05), gap = height * own.between(0.01, 0.9);
  std::vector<Vec2> lift{{0.0, 0.0}};
  const auto dwell_to = [&lift, lobe](double end) { // points so close that the smooth curve hardly swings between them
    const double from = lift.back().x(), parts = std::ceil((end - from) / (0.25 * lobe));
    for (double k = 1.0; k < parts; ++k) lift.emplace_back(from + (end - from) * k / parts, 0.0);
  };
  dwell_to(top - 0.5 * lobe);
  for (const double share : {-0.5, -0.3, -0.15, 0.0, 0.15, 0.3, 0.5})
    lift.emplace_back(top + share * lobe, height * std::pow(std::cos(std::numbers::pi * share), 2));
  dwell_to(k_turn);
  lift.emplace_back(k_turn, 0.0);
  const LiftCurve curve(lift);
  Passing passing;
  std::string table;
  for (const Vec2& p : lift) table += (table.empty() ? "[" : ", ") + point(p.x(), p.y());
  passing.text = k_no_gravity + body("shaft", "mass = 1.0; inertia = 1e6; angular_velocity = " + digits(rate)) +
                 element("revolute", "pin", "a = 'shaft'") + body("follower", "mass = 1.0; inertia = 1.0; position = [0.0, 1.0]") +
                 element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
                 element("cam", "it",
                         "a = 'follower'; cam = 'shaft'; start_angle = " + digits(start) + "; stiffness = 1e5; lift = " + table +
                             "]; gap = " + digits(gap));
  // The flank rises from the lobe's foot to its top; the spline may dip a little before it.
  const double wanted = curve.at(start).value + gap;
  double low = start;
  while (curve.at(low).value < wanted) low += 1e-4 * lobe;
  double from = low - 1e-4 * lobe;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (from + low);
    (curve.at(middle).value < wanted ? from : low) = middle;
  }
  passing.first = (low - start) / rate;
  passing.end = k_turn * own.decades(0.0, 2.0) / rate;
  passing.end = std::max(passing.end, 1.05 * passing.first);
  passing.off = (1e-9 + 1e-12 / std::abs(curve.at(low).slope)) / rate;
  return passing;
}

// A lobe by formula, h exp(−k (1 − cos(φ − φ_top))): it touches where it exceeds its value at the start by the gap, at
// |φ − φ_top| = acos(1 − ln(h/lift)/k).
Passing random_cam_by_formula(RandomNumber& own) {
  const double rate = own.decades(0.0, 2.477), height = own.between(1e-3, 0.02), gap = height * own.between(0.01, 0.9),
               sharpness = own.decades(1.5, 5.0), top = own.between(0.7, k_turn - 0.7); // half a lobe is 0.55 rad at most
  const double lift = gap + height * std::exp(-sharpness * (1.0 - std::cos(top)));
  const double half = std::acos(1.0 - std::log(height / lift) / sharpness);
  Passing passing;
  passing.text = k_no_gravity + body("shaft", "mass = 1.0; inertia = 1e6; angular_velocity = " + digits(rate)) +
                 element("revolute", "pin", "a = 'shaft'") + body("follower", "mass = 1.0; inertia = 1.0; position = [0.0, 1.0]") +
                 element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
                 element("cam", "it",
                         "a = 'follower'; cam = 'shaft'; stiffness = 1e5; gap = " + digits(gap) + "; formula = \"" + metres(height) +
                             " * exp(-" + digits(sharpness) + " * (1 - cos(value - " + digits(top) + ")))\"");
  passing.first = (top - half) / rate;
  passing.end = std::max(k_turn * own.decades(0.0, 2.0) / rate, 1.05 * passing.first);
  passing.off = (1e-9 + 1e-12 / (lift * sharpness * std::sin(half))) / rate; // 1e-12 m of rounding, divided by the slope
  return passing;
}

// A lobe in one turn only, up to 300 turns away, alone, on a wave that repeats itself never, or on a slope away from the follower.
Passing random_single_lobe(RandomNumber& own) {
  const double rate = own.either(1.0, 300.0), height = own.between(1e-3, 0.02), gap = height * own.between(0.1, 0.9);
  const double width = own.decades(-3.0, -0.5), top = std::copysign(k_turn * own.decades(0.0, 2.477), rate);
  const int kind = static_cast<int>(own.between(0.0, 3.0));
  const double wave = kind == 1 ? 0.05 * gap : 0.0, slope = kind == 2 ? -std::copysign(own.decades(-5.0, -2.0), rate) : 0.0;
  const auto lift = [&](double x) {
    return height * std::exp(-(x - top) * (x - top) / (width * width)) + wave * std::sin(std::sqrt(2.0) * x) + slope * (x - top);
  };
  double before = top - std::copysign(8.0 * width, rate), behind = top; // in which it rises, and touches once
  const double start_gap = gap + lift(0.0);
  if (lift(0.0) > 0.5 * (height - gap)) return random_single_lobe(own); // the lobe is no higher than the way down to it
  for (int i = 0; i < 200; ++i) (lift(0.5 * (before + behind)) < start_gap ? before : behind) = 0.5 * (before + behind);
  Passing passing;
  passing.text = k_no_gravity + body("shaft", "mass = 1.0; inertia = 1e6; angular_velocity = " + digits(rate)) +
                 element("revolute", "pin", "a = 'shaft'") + body("follower", "mass = 1.0; inertia = 1.0; position = [0.0, 1.0]") +
                 element("prismatic", "guide", "a = 'follower'; axis = [0.0, 1.0]") +
                 element("cam", "it",
                         "a = 'follower'; cam = 'shaft'; stiffness = 1e5; gap = " + digits(gap) + "; formula = \"" + metres(height) +
                             " * exp(-((value - (" + digits(top) + ")) / " + digits(width) + ")^2) + " + metres(wave) +
                             " * sin(sqrt(2) * value) + (" + metres(slope) + ") * (value - (" + digits(top) + "))\"");
  passing.first = behind / rate;
  passing.end = 1.05 * (top + std::copysign(10.0 * width, rate)) / rate;
  const double step = 1e-3 * width, rise = std::abs(lift(behind + step) - lift(behind - step)) / (2.0 * step);
  passing.off = (1e-9 + 1e-12 * std::abs(top) + 1e-12 / rise) / std::abs(rate); // rounding of the angle, and 1e-12 m by the slope
  return passing;
}

// Two arms that turn at rates of their own and meet with their ends, after many turns or never. The first time is found by steps that
// the distance of the ends cannot use up.
Passing random_meeting(RandomNumber& own) {
  const double rate[2] = {own.either(1.0, 300.0), own.either(1.0, 300.0)}, start[2] = {own.between(0.3, 2.8), own.between(0.3, 2.8)};
  const double apart = own.between(1.7, 1.99), radius = own.decades(-2.5, -1.0);
  const auto distance = [&](double t) {
    const double a = start[0] + rate[0] * t, b = start[1] + rate[1] * t;
    return std::hypot(apart + std::cos(b) - std::cos(a), std::sin(b) - std::sin(a));
  };
  if (distance(0.0) <= radius) return random_meeting(own); // they begin in touch
  Passing passing;
  passing.end = k_turn * own.decades(1.0, 2.0) / std::min(std::abs(rate[0]), std::abs(rate[1]));
  const double fastest = std::abs(rate[0]) + std::abs(rate[1]);
  double t = 0.0;
  while (t < passing.end && distance(t) > radius + 1e-11) t += (distance(t) - radius) / fastest;
  if (t < passing.end) passing.first = t;
  const double step = 1e-7 / fastest, slope = std::abs(distance(t + step) - distance(t - step)) / (2e-7);
  passing.off = (1e-8 + 1e-10 / std::max(slope, 1e-9)) / fastest;
  for (int i = 0; i < 2; ++i)
    passing.text +=
        body(i == 0 ? "one" : "two", "mass = 1.0; inertia = 1e6; position = " + point(i * apart, 0.0) + "; angle = " + digits(start[i]) +
                                         "; angular_velocity = " + digits(rate[i])) +
        element("revolute", i == 0 ? "pin one" : "pin two",
                std::string("a = '") + (i == 0 ? "one" : "two") + "'; b = { body = 'ground', at = " + point(i * apart, 0.0) + " }");
  passing.text =
      k_no_gravity + passing.text +
      element("circle_contact", "it",
              "a = { body = 'one', point = [1.0, 0.0] }; b = { body = 'two', point = [1.0, 0.0] }; stiffness = 1e6; radius_b = " +
                  digits(radius));
  return passing;
}

// A body that flies straight past a circle, or over a line in a condition.
Passing random_flight(RandomNumber& own, bool has_formula) {
  const double v = own.decades(0.0, 2.5), way = own.between(0.5, 20.0), radius = own.decades(-5.0, -1.0),
               aside = radius * own.between(0.0, 0.9);
  Passing passing;
  passing.text =
      k_no_gravity + body("flier", "mass = 1.0; inertia = 1.0; velocity = [" + digits(v) + ", 0.0]; position = " + point(0.0, aside));
  passing.text +=
      has_formula
          ? "[[action]]\nname = 'it'\nwhen = \"hypot(flier.x - " + metres(way) + ", flier.y) < " + metres(radius) + "\"\ndo = ['stop']\n"
          : element("circle_contact", "it",
                    "a = 'flier'; b = { body = 'ground', at = " + point(way, 0.0) + " }; stiffness = 1e3; radius_b = " + digits(radius));
  const double half = std::sqrt(radius * radius - aside * aside);
  passing.first = (way - half) / v;
  passing.end = own.between(1.2, 5.0) * way / v;
  passing.off = (1e-9 + 1e-13 * way / (half / radius)) / v;
  return passing;
}

// A body that flies through a gate given by four comparisons: it is inside from the last entry to the first exit.
Passing random_gate(RandomNumber& own) {
  const double v = own.decades(0.0, 2.0), direction = own.between(0.2, 1.3), vx = v * std::cos(direction), vy = v * std::sin(direction);
  const double t = own.between(0.5, 2.0), width = own.decades(-5.0, -2.0) / v;                                // s
  const double enters[2] = {t, t + own.between(-0.5, 0.5) * width}, leaves[2] = {t + width, t + 1.2 * width}; // of x, y
  Passing passing;
  passing.text =
      k_no_gravity + body("flier", "mass = 1.0; inertia = 1.0; velocity = " + point(vx, vy)) + "[[action]]\nname = 'it'\nwhen = \"";
  const std::string x[2] = {metres(vx * enters[0]), metres(vx * leaves[0])}, y[2] = {metres(vy * enters[1]), metres(vy * leaves[1])};
  if (own.chance(0.5)) passing.text += "flier.x > " + x[0] + " && flier.x < " + x[1] + " && flier.y > " + y[0] + " && flier.y < " + y[1];
  else passing.text += "min(min(flier.x - " + x[0] + ", " + x[1] + " - flier.x), min(flier.y - " + y[0] + ", " + y[1] + " - flier.y)) > 0 ";
  passing.text += "\"\ndo = ['stop']\n";
  passing.first = std::max(enters[0], enters[1]);
  passing.end = own.between(1.2, 5.0) * (t + 2.0 * width);
  passing.off = 1e-9 / v + 1e-12 * t;
  return passing;
}

// As a gate, by bells in x and y that are above 0.5 within `half` of their middles; far from these both underflow.
Passing random_bells(RandomNumber& own) {
  const double v = own.decades(0.0, 2.0), direction = own.between(0.2, 1.3), vx = v * std::cos(direction), vy = v * std::sin(direction);
  const double t = own.between(0.5, 2.0), half = own.decades(-5.0, -2.0); // s, m
  const double x = vx * t, y = vy * t + half * own.between(-0.5, 0.5), width = half / std::sqrt(std::log(2.0));
  const auto bell = [&](const std::string& coordinate, double middle) {
    return "exp(-((flier." + coordinate + " - " + metres(middle) + ") / " + metres(width) + ")^2)";
  };
  Passing passing;
  passing.text =
      k_no_gravity + body("flier", "mass = 1.0; inertia = 1.0; velocity = " + point(vx, vy)) + "[[action]]\nname = 'it'\nwhen = \"" +
      (own.chance(0.5) ? "min(" + bell("x", x) + ", " + bell("y", y) + ") > 0.5" : bell("x", x) + " > 0.5 && " + bell("y", y) + " > 0.5") +
      "\"\ndo = ['stop']\n";
  passing.first = std::max((x - half) / vx, (y - half) / vy);
  if (passing.first > std::min((x + half) / vx, (y + half) / vy)) passing.first = std::numeric_limits<double>::infinity();
  passing.end = own.between(1.2, 5.0) * t;
  passing.off = 1e-9 / v + 1e-12 * t;
  return passing;
}

// A body that flies at `v` past a force across its way, which acts for an instant only, or past what heats it for as long.
struct Field {
  std::string text, channel;
  double wanted = 0.0; ///< of the channel at the end
  double peak = 0.0;   ///< what the peak adds to it
  double end = 0.0;    ///< s
};

Field random_field(const std::string& kind, RandomNumber& own) {
  const double v = own.decades(0.0, 1.5), at = own.between(0.5, 5.0), width = own.decades(-4.0, -2.0), push = own.decades(1.0, 3.0);
  const std::string distance = "(flier.x - " + metres(at) + ")", ratio = "(" + distance + " / " + metres(width) + ")";
  const bool is_state = kind == "state";
  const std::string strength = is_state ? "'" + digits(push) + " K/s'" : "'" + digits(push) + " N'", none = is_state ? "'0 K/s'" : "'0 N'";
  std::string formula;
  double integral = 0.0; // of the peak over the way, parts of push · width
  double slope = 0.0;    // N/m
  if (kind == "gaussian" || kind == "gaussian on a slope" || is_state) {
    formula = strength + " * exp(-" + ratio + "^2)";
    integral = std::sqrt(std::numbers::pi);
    if (kind == "gaussian on a slope") slope = push * own.decades(-2.0, 0.5) / at;
    if (slope > 0.0) formula += " + '" + digits(slope) + " N/m' * flier.x";
  } else if (kind == "lorentzian") {
    formula = strength + " / (1 + " + ratio + "^2)^2";
    integral = 0.5 * std::numbers::pi;
  } else if (kind == "box") {
    formula = "flier.x > " + metres(at) + " && flier.x < " + metres(at + width) + " ? " + strength + " : " + none;
    integral = 1.0;
  } else if (kind == "triangle") {
    formula = strength + " * max(0, min(1 + " + ratio + ", 1 - " + ratio + "))";
    integral = 1.0;
  } else { // within a circle
    formula = "hypot"
              "(" +
              distance + ", '0 m') < " + metres(width) + " ? " + strength + " : " + none;
    integral = 2.0;
  }
  Field field;
  field.end = own.between(1.5, 4.0) * (at + 10.0 * width) / v;
  field.peak = integral * push * width / v;
  field.wanted = field.peak + 0.5 * slope * v * field.end * field.end;
  field.text = k_no_gravity + body("flier", "mass = 1.0; inertia = 1.0; velocity = " + point(v, 0.0));
  if (is_state) {
    field.text += "[[state]]\nname = 'heat'\nunit = 'K'\nrate = \"" + formula + "\"\n";
    field.channel = "heat.value";
  } else {
    field.text += element("force", "field", "a = 'flier'; coordinate = 'y'; formula = \"" + formula + "\"");
    field.channel = "flier.vy";
  }
  return field;
}

// A thousandth: what a peak adds is found by the tolerance of 1e-8 of what moves, and of it a step that ends in it sees all. On a slope the
// tolerance is one of all that the force adds, of which ten times that is allowed, and the step that enters the peak is as accurate as its
// estimate: tsit5 lost 1.8 % of one of 600 peaks.
void check_fields(const std::string& kind, int count) {
  int missed = 0;
  for (int seed = 0; seed < count; ++seed) {
    RandomNumber own(static_cast<std::uint64_t>(seed) * 104729 + kind.size());
    const Field field = random_field(kind, own);
    const Model model = scene(field.text + "[simulation]\nstep = 1e-3\n");
    for (const char* method : {"auto", "dop853", "tsit5", "rodas5p"}) {
      Run found = run(model, {method, 1e-8, field.end, 0.0});
      const double allowed = field.wanted > field.peak ? 2e-2 * field.peak + 1e-7 * field.wanted : 1e-3 * field.peak;
      if (std::abs(found.last(field.channel) - field.wanted) <= allowed) continue;
      ++missed;
      MESSAGE(kind << " " << seed << " " << std::string(method) << ": " << digits(found.last(field.channel)) << " for "
                   << digits(field.wanted) << ", end " << digits(field.end) << "\n" + field.text);
    }
  }
  CHECK_MESSAGE(missed == 0, kind);
}

struct Found {
  double first = std::numeric_limits<double>::infinity();
  long steps = 0;
};

// Up to the first event of the element.
Found find(const Passing& passing, const System& system, const std::string& method, RandomNumber& own) {
  SimulationOptions wanted = options({"dop853", 1e-8, passing.end, 0.0});
  wanted.integrator = method;
  wanted.has_extremes = own.chance(0.5);
  if (method == "rk4") wanted.settings.step = passing.end * own.decades(-3.0, 0.0);
  Simulation simulation(system, system.initial_state(), wanted);
  Found found;
  bool goes_on = true;
  while (goes_on && std::isinf(found.first)) {
    goes_on = simulation.advance();
    for (const Event& event : simulation.events())
      if (event.element == passing.element && event.t > 0.0 && std::isinf(found.first)) found.first = event.t;
  }
  found.steps = simulation.statistics().steps;
  return found;
}

// Runs `count` scenes that `make` draws by all methods, and checks the first touch.
template <class Make> void check_all(const std::string& kind, int count, const Make& make) {
  int missed = 0, late = 0;
  for (int seed = 0; seed < count; ++seed) {
    RandomNumber own(static_cast<std::uint64_t>(seed) * 7919 + kind.size());
    const Passing passing = make(own);
    const auto system = compile(scene(passing.text + "[simulation]\nstep = 1e-3\n"));
    for (const char* method : {"auto", "dop853", "tsit5", "rodas5p", "rk4"}) {
      const Found found = find(passing, *system, method, own);
      const bool is_missed = std::isinf(found.first) != std::isinf(passing.first) || found.first > passing.first + 1e3 * passing.off;
      const bool is_late = !is_missed && !std::isinf(found.first) && std::abs(found.first - passing.first) > passing.off;
      missed += is_missed ? 1 : 0;
      late += is_late ? 1 : 0;
      if (is_missed || is_late)
        MESSAGE(kind << " " << seed << " " << std::string(method) << ": " << digits(found.first) << " for " << digits(passing.first)
                     << " s, allowed " << passing.off << ", end " << passing.end << ", steps " << found.steps
                     << (is_missed ? "\n" + passing.text : std::string()));
    }
  }
  CHECK_MESSAGE(missed == 0, kind);
  CHECK_MESSAGE(late == 0, kind);
}

int cases() {
  const char* const wanted = std::getenv("STEPLAP_PASSINGS"); // more than a test has time for
  return wanted ? std::atoi(wanted) : 20;
}

} // namespace

TEST_CASE("what the end of an arm touches in even rotation is found by every method, however long its steps") {
  for (const std::string& kind : kinds()) check_all(kind, cases(), [&](RandomNumber& own) { return random_passing(kind, own); });
}

TEST_CASE("lobes of cams are found by every method") {
  check_all("cam", 2 * cases(), random_cam);
  check_all("cam by formula", 2 * cases(), random_cam_by_formula);
  check_all("single lobe", 2 * cases(), random_single_lobe);
}

TEST_CASE("two arms that turn evenly meet where they do, after however many turns") { check_all("meeting", 2 * cases(), random_meeting); }

TEST_CASE("what is flown past straight is found by every method") {
  check_all("flight", 2 * cases(), [](RandomNumber& own) { return random_flight(own, false); });
}

TEST_CASE("a gate of several comparisons is passed by no method unseen") {
  check_all("gate", 2 * cases(), random_gate);
  check_all("bells", 2 * cases(), random_bells);
}

TEST_CASE("a force or a rate by formula that acts for an instant acts") {
  for (const char* kind : {"gaussian", "gaussian on a slope", "lorentzian", "state", "box", "triangle", "circle"})
    check_fields(kind, 2 * cases());
}

TEST_CASE("the knots of a lift by formula lie about its narrow lobes, and a harmonic has none") {
  const auto knots = [](const std::string& formula) {
    const auto system = compile(scene(
        body("cam", "mass = 1.0; inertia = 1.0; angular_velocity = 1.0") + element("revolute", "pin", "a = 'cam'") +
        body("foot", "mass = 1.0; inertia = 0.1; position = [0.0, 1.0]") + element("prismatic", "guide", "a = 'foot'; axis = [0.0, 1.0]") +
        element("cam", "it", "a = 'foot'; cam = 'cam'; gap = 1e-4; stiffness = 1e5; formula = \"" + formula + "\"") +
        "[simulation]\nstep = 1e-3\n"));
    std::size_t count = 0;
    const TurnTable table = turn_table_of(*system);
    for (const Turn& turn : table.turns())
      for (const TurnKnots& each : turn.knots) count += each.at.size();
    return count;
  };
  CHECK(knots("'10 mm' * (1 - cos(value))") == 0);
  CHECK(knots("'10 mm' * sin(3 * value)") == 0);
  CHECK(knots("'10 mm' * sin(20 * value)") >= 20);                              // a wave is shorter than a step
  CHECK(knots("'1 mm' * value + '10 mm' * exp(-((value - 10) / 0.01)^2)") > 5); // a lobe in the second turn only
  // A lobe of 5 mrad at 11/16 of a turn: a place at which a turn is halved lies on it.
  CHECK(knots("'10 mm' * exp(-65536 * (1 - cos(value - 4.3236)))") > 5);
  const std::size_t narrow = knots("'10 mm' * exp(-(sin((value - 3.3) / 2) / 0.002)^2)");
  CHECK(narrow > 5); // halvings from a turn to the lobe of 4 mrad
  CHECK(narrow < 200);
  // One lobe of 10 mm at 64 and at 160 000 turns, and on a slope of which it is a tenth.
  CHECK(knots("'10 mm' * exp(-((value - 400) / 0.01)^2)") > 5);
  CHECK(knots("'10 mm' * exp(-((value + 1e6) / 0.01)^2)") > 5);
  CHECK(knots("'100 mm' * value + '10 mm' * exp(-((value - 3) / 0.01)^2)") > 5);
  CHECK(knots("'100 mm' * value + '10 mm' * exp(-((value - 300) / 0.01)^2)") > 5);
  CHECK(knots("'100 mm' * value^2") == 0);
  CHECK(knots("'10 mm' * sin(value / 3)") == 0); // comes again after three turns
  // A lobe in every third turn: there are knots in each.
  CHECK(knots("'10 mm' * exp(-1e4 * (1 - cos((value - 10) / 3)))") > 5);
}

TEST_CASE("a lift whose lobes nothing bounds ends the run where its search ended") {
  const auto turned = [](const std::string& formula, double turns) {
    const auto system = compile(scene(
        k_no_gravity + body("cam", "mass = 1.0; inertia = 1.0; angular_velocity = 1.0") + element("revolute", "pin", "a = 'cam'") +
        body("foot", "mass = 1.0; inertia = 0.1; position = [0.0, 1.0]") + element("prismatic", "guide", "a = 'foot'; axis = [0.0, 1.0]") +
        element("cam", "it", "a = 'foot'; cam = 'cam'; gap = 0.1; stiffness = 1e5; formula = \"" + formula + "\"")));
    SimulationOptions options;
    options.end = k_turn * turns;
    return simulate(*system, system->initial_state(), options).final_state.t;
  };
  // The angle of the second wave grows with the square: its waves become narrower without end.
  const std::string chirp = "'1 mm' * sin(value^2)";
  CHECK(turned(chirp, 10.0) == doctest::Approx(10.0 * k_turn));
  CHECK_THROWS_WITH_AS(static_cast<void>(turned(chirp, 2000.0)), doctest::Contains("does not repeat itself"), NumericalFailure);
  CHECK(turned("'1 mm' * sin(value / 3)", 2000.0) == doctest::Approx(2000.0 * k_turn)); // every third turn is the same
}
