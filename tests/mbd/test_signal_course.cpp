// When signals begin, are at their full size, and end: read from their pieces, of every kind and made of others.
#include "mbd/model/signal_course.h"

#include "mbd/model/signal_algebra.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace steplap;

namespace {

constexpr double k_never = std::numeric_limits<double>::infinity();

Signal::Piece level(double start, double value) {
  Signal::Piece piece;
  piece.start = start;
  piece.c[0] = value;
  return piece;
}
Signal::Piece ramp(double start, double value, double slope) {
  Signal::Piece piece = level(start, value);
  piece.c[1] = slope;
  return piece;
}
Signal::Piece wave(double start, double amplitude, double period) {
  Signal::Piece piece = level(start, 0.0);
  piece.harmonics.push_back({amplitude, 2.0 * std::numbers::pi / period, 0.0});
  return piece;
}

void check(const Signal& signal, double begins, double full, double ends, double period) {
  const SignalCourse course = course_of(signal);
  CHECK(course.begins == begins);
  CHECK(course.full == full);
  CHECK(course.ends == ends);
  CHECK(course.period == doctest::Approx(period).epsilon(1e-12));
}

} // namespace

TEST_CASE("a level, whatever it is, has no course") {
  CHECK(course_of(Signal()).is_level());
  CHECK(course_of(Signal::constant(3.0)).is_level());
  CHECK(course_of(Signal({level(-1.0, 3.0)})).is_level());
  CHECK(course_of(Signal({level(0.5, 0.0), level(0.7, 0.0)})).is_level());
  CHECK(course_of(Signal({ramp(-1.0, 0.0, 1.0), level(-0.5, 0.0)})).is_level()); // over before the run
}

TEST_CASE("a pulse ends where it is zero again, or at the level that it began from") {
  check(Signal({ramp(0.5, 0.0, 1.0), level(0.7, 0.0)}), 0.5, k_never, 0.7, 0.0);
  check(Signal({level(0.0, 2.0), level(0.7, 0.0)}), 0.0, k_never, 0.7, 0.0);
  check(Signal({level(0.0, 2.0), ramp(0.5, 2.0, 1.0), level(0.7, 2.0)}), 0.5, k_never, 0.7, 0.0);
  check(Signal({level(0.0, 0.0), ramp(0.5, 0.0, 1.0), level(0.7, 0.0), level(0.9, 0.0)}), 0.5, k_never, 0.7, 0.0);
}

TEST_CASE("what goes to another level is full from there on") {
  check(Signal({ramp(0.5, 0.0, 1.0), level(0.7, 0.2)}), 0.5, 0.7, k_never, 0.0);
  check(Signal({level(0.5, 2.0)}), 0.5, 0.5, k_never, 0.0);
  check(delayed(Signal::constant(1.0), 0.3), 0.3, 0.3, k_never, 0.0);
}

TEST_CASE("waves are full where nothing but they is left, with their mean period") {
  check(Signal({wave(0.5, 2.0, 0.2)}), 0.5, 0.5, k_never, 0.2);
  check(Signal({ramp(0.0, 0.0, 1.0), wave(0.5, 2.0, 0.2)}), 0.0, 0.5, k_never, 0.2);
  Signal::Piece two = wave(0.5, 2.0, 0.2);
  two.harmonics.push_back({2.0, 2.0 * std::numbers::pi / 0.1, 0.0});
  check(Signal({two}), 0.5, 0.5, k_never, std::sqrt(2.0 / (25.0 + 100.0)));
  // With an end: ten periods are a state of their own, nine are a pulse.
  check(Signal({wave(0.5, 2.0, 0.2), level(2.75, 0.0)}), 0.5, 0.5, 2.75, 0.2);
  check(Signal({wave(0.5, 2.0, 0.2), level(2.25, 0.0)}), 0.5, k_never, 2.25, 0.0);
}

TEST_CASE("waves that grow as a haversine are at their full size where they have grown") {
  Signal::Piece rise = wave(0.5, 0.5, 0.01);
  for (const double beat : {0.01 / (1.0 - 0.01 / 2.0), 0.01 / (1.0 + 0.01 / 2.0)}) // ½ − ½ cos over 1 s, times a cosine of 100 Hz
    rise.harmonics.push_back({-0.25, 2.0 * std::numbers::pi / beat, 0.0});
  check(Signal({rise, wave(1.5, 1.0, 0.01), level(3.0, 0.0)}), 0.5, 1.5, 3.0, 0.01);
}

TEST_CASE("a product of a wave and its envelope has the course of the envelope") {
  const Signal carrier({wave(0.0, 2.0, 0.1)}), envelope({ramp(0.5, 0.0, 2.0), level(1.0, 1.0), ramp(3.0, 1.0, -2.0), level(3.5, 0.0)});
  check(product_of({&carrier, &envelope}), 0.5, 1.0, 3.5, 0.1);
  const SignalCourse doubled = course_of(sum_of({&envelope, &envelope}, {1.0, -1.0}));
  CHECK(doubled.is_level()); // what cancels to rounding is nothing
}
