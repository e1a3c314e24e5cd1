// Contacts of round things, whatever the method and its tolerance: a step that was right in flight is too long for the
// contact that ends it, and a gap of something round is not as smooth as the flight past it.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string number(double x) { return std::to_string(x); }

const std::vector<Settings> k_loose_to_tight = {{"dop853", 1e-10}, {"dop853", 1e-8}, {"dop853", 1e-5},  {"dop853", 1e-3},
                                                {"tsit5", 1e-8},   {"tsit5", 1e-5},  {"rodas5p", 1e-8}, {"rodas5p", 1e-5},
                                                {"rodas5p", 1e-4}, {"auto", 1e-8},   {"auto", 1e-6}};

} // namespace

TEST_CASE("a ball bounces to rest on a hill and rolls off it: all methods and tolerances end at the same place") {
  const std::string hill = body("ball", "mass = 857.1; inertia = 66.02; position = [0.264, 2.32996]") +
                           element("circle_contact", "hill",
                                   "a = 'ball'; b = { body = 'ground', at = [0.0, 0.0] }\n"
                                   "radius_a = 0.306; radius_b = 2.0; law = 'hunt_crossley'; exponent = 1.5\n"
                                   "stiffness = 9353000000.0; dissipation = 1.389");
  for (Settings settings : k_loose_to_tight) {
    CAPTURE(settings.integrator);
    CAPTURE(settings.step_or_tolerance);
    settings.end = 2.0;
    const Run r = run(hill, settings);
    // By an independent integration of the ball's two coordinates, events located, to 1e-9. Some thirty contacts turn
    // an error of a tolerance into some hundred; positions are of the order of 3 m.
    const double tolerance = std::max(1e-5, 300.0 * settings.step_or_tolerance);
    CHECK(std::abs(r.last("ball.x") - 3.47594581) < tolerance);
    CHECK(std::abs(r.last("ball.y") + 2.72613785) < tolerance);
    const RunStatistics& s = r.result.statistics;
    CHECK(s.energy_residual < std::max(1e-7, 10.0 * settings.step_or_tolerance) * s.energy_exchanged);
  }
}

TEST_CASE("stiff and soft, in every power: without dissipation a central blow gives the velocity back") {
  // On a circle, a ring and a segment, along the line of centres: one dimension, energy is kept.
  const std::string shapes[] = {"circle_contact|radius_a = 0.3; radius_b = 0.4",
                                "circle_contact|radius_a = 0.1; radius_b = 4.0; inside = true",
                                "segment_contact|radius = 0.3; from = [-1.0, 0.0]; to = [1.0, 0.0]; thickness = 0.1"};
  for (const std::string& shape : shapes)
    for (const double power : {1.0, 1.5, 2.0, 3.0})
      for (const double depth : {1e-4, 3e-2}) // that the blow reaches: ½ m v² = k dⁿ⁺¹/(n + 1)
        for (Settings settings : k_loose_to_tight) {
          const std::size_t bar = shape.find('|');
          const double stiffness = 0.5 * 9.0 * (power + 1.0) / std::pow(depth, power + 1.0);
          const std::string text =
              k_no_gravity + body("ball", "mass = 1.0; inertia = 0.02; position = [0.0, 1.5]; velocity = [0.0, -3.0]") +
              element(shape.substr(0, bar), "wall",
                      "a = 'ball'; b = { body = 'ground', at = [0.0, 0.0] }; law = 'hunt_crossley'\nstiffness = " + number(stiffness) +
                          "; exponent = " + number(power) + ";" + shape.substr(bar + 1));
          CAPTURE(text);
          CAPTURE(settings.integrator);
          CAPTURE(settings.step_or_tolerance);
          settings.end = 2.5;
          const Run r = run(text, settings);
          REQUIRE(r.event_times("wall").size() == 2);
          // The place is known to a tolerance of the way come, of a metre or two, in each step: so much of the depth is
          // uncertain, and n times that of the force. Some dozens of steps in all; a tenth at the very most.
          const double uncertain = settings.step_or_tolerance * (100.0 + power * 2.0 / depth);
          CHECK(std::abs(r.last("ball.vy") - 3.0) < 3.0 * std::min(0.1, std::max(1e-6, uncertain)));
        }
}

TEST_CASE("a Kelvin-Voigt floor is not stepped over by a method that would damp its vibration away") {
  const std::string floor = body("ball", "mass = 16.8; inertia = 0.5; position = [0.0, 0.888]") +
                            element("unilateral_contact", "floor", "a = 'ball'; stiffness = 1.8e9; damping = 3.5e4");
  for (Settings settings : k_loose_to_tight) {
    CAPTURE(settings.integrator);
    CAPTURE(settings.step_or_tolerance);
    settings.end = 0.9;
    const Run r = run(floor, settings);
    // Falls 0.425 s; a contact that never pulls gives back exp(−2ζ arctan(√(1 − ζ²)/ζ)/√(1 − ζ²)) of the velocity.
    const double zeta = 3.5e4 / (2.0 * std::sqrt(1.8e9 * 16.8));
    const double fall = std::sqrt(2.0 * 0.888 / 9.81), speed = std::sqrt(2.0 * 9.81 * 0.888);
    const double root = std::sqrt(1.0 - zeta * zeta);
    const double expected = std::exp(-2.0 * zeta * std::atan(root / zeta) / root);
    REQUIRE(r.event_times("floor", "closes").size() == 1);
    const double rise = r.last("ball.vy") + 9.81 * (0.9 - fall);
    // Gravity during the contact of 0.3 ms, and that it lasts so long, are 1e-3 of the velocity.
    CHECK(std::abs(rise / speed - expected) < 3e-3);
  }
}

TEST_CASE("a fast ball does not fly through a pin, or past a hill's flank, within one step") {
  // No forces: the flight is one step. A point passes a pin of 1 mm at 5 m/s, half a radius off its middle.
  const std::string pin = k_no_gravity + body("ball", "mass = 1.0; inertia = 1.0; position = [-3.0, 0.0005]; velocity = [5.0, 0.0]") +
                          element("circle_contact", "pin",
                                  "a = 'ball'; b = { body = 'ground', at = [0.0, 0.0] }\n"
                                  "radius_a = 0.0; radius_b = 0.001; stiffness = 1e9");
  // A bounce on a hill, then a flight of a second down its flank: into the hill again.
  const std::string flank = body("ball", "mass = 14.6437; inertia = 0.840051; position = [0.864576, 3.56512]; velocity = [0.527402, 0.0]") +
                            element("circle_contact", "hill",
                                    "a = 'ball'; b = { body = 'ground', at = [0.0, 0.0] }\nradius_a = 0.378702\n"
                                    "radius_b = 2.9226; law = 'hunt_crossley'; exponent = 1.2; stiffness = 2.759381e8; dissipation = 0.05");
  for (Settings settings : k_loose_to_tight) {
    CAPTURE(settings.integrator);
    CAPTURE(settings.step_or_tolerance);
    settings.end = 1.5;
    const Run stopped = run(pin, settings);
    REQUIRE(stopped.event_times("pin", "closes").size() == 1);
    CHECK(std::abs(stopped.event_times("pin", "closes")[0] - (3.0 - 0.001 * std::sqrt(0.75)) / 5.0) < 1e-9);
    CHECK(run(flank, settings).event_times("hill", "closes").size() == 2);
  }
}
