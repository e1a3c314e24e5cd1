// A contact that touches at the start, and is pressed by a force that grows from zero, does not open by rounding.
//
// A gap of zero comes out of places of metres. A method that rounds a place anew which has not moved yet makes a gap of it, and the
// first event of the run.
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

using namespace steplap;
using namespace steplap::testing;
using random::RandomNumber;

namespace {

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return std::strpbrk(text, ".en") ? text : std::string(text) + ".0";
}

std::string listed(const std::vector<Event>& events) {
  std::string text;
  for (const Event& event : events) text += digits(event.t) + " " + event.element + " " + event.words() + "\n";
  return text;
}

const char* const k_methods[] = {"auto", "dop853", "tsit5", "rodas5p"};

// A ladder of 3 m that leans on a smooth wall at 75°, and slides from there: the wall presses at once, with a force that grows from
// zero. It leaves the wall where its slope is down to sin = ⅔ sin 75°.
std::string ladder(double stiffness) {
  const double x = 1.5 * std::cos(75.0 * M_PI / 180.0), y = 1.5 * std::sin(75.0 * M_PI / 180.0);
  const std::string law = "stiffness = " + digits(stiffness) + "; damping = " + digits(0.5 * std::sqrt(stiffness));
  return body("ladder",
              "mass = 10.0; inertia = 7.5; position = [" + digits(x) + ", " + digits(y) + "]; angle = " + digits(105.0 * M_PI / 180.0)) +
         element("unilateral_contact", "wall", "a = { body = \"ladder\", point = [1.5, 0.0] }; normal = [1.0, 0.0]; " + law) +
         element("unilateral_contact", "floor", "a = { body = \"ladder\", point = [-1.5, 0.0] }; " + law);
}

int openings(const Run& run, const std::string& element) { return static_cast<int>(run.event_times(element, "opens").size()); }

} // namespace

TEST_CASE("touching: a contact that begins to press does not open by rounding") {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    CAPTURE(seed);
    RandomNumber random(seed);
    const double stiffness = random.decades(6.0, 9.0), tolerance = random.decades(-10.0, -6.0);
    for (const char* method : k_methods) {
      CAPTURE(std::string(method));
      const Run leans = run(ladder(stiffness), {method, tolerance, 0.8});
      CAPTURE(listed(leans.result.events));
      CHECK(openings(leans, "wall") == 0); // the ladder leaves it at 0.856 s
    }
  }
}

// It does leave it: not at another time than without rounding.
TEST_CASE("touching: what opens by its motion opens") {
  double first = 0.0;
  for (const char* method : k_methods) {
    CAPTURE(std::string(method));
    const Run leans = run(ladder(1e8), {method, 1e-9, 1.0});
    const std::vector<double> opens = leans.event_times("wall", "opens");
    REQUIRE(opens.size() == 1);
    CHECK(opens[0] == doctest::Approx(0.856).epsilon(1e-3));
    if (first == 0.0) first = opens[0];
    CHECK(std::abs(opens[0] - first) < 1e-5);
  }
}
