// Rest of scenes beyond some tens of bodies, which sparse algebra finds: closed forms from poses far off, the same rests as
// by dense algebra, what has no rest.
#include "mbd/rest/bordered_system.h"
#include "tests/physics/rest_scene.h"

#include <cmath>
#include <cstdio>
#include <doctest/doctest.h>
#include <numbers>
#include <string>

using namespace steplap;
using namespace steplap::testing;

namespace {

std::string numbered(const std::string& name, int i) { return name + " " + std::to_string(i); }
std::string quoted(const std::string& name) { return "\"" + name + "\""; }
std::string at(const std::string& name, double x, double y) { return "{ body = " + quoted(name) + ", point = " + point(x, y) + " }"; }

// A rod of 1 m on the end of the one before; the first on the ground's origin.
std::string rod(int i, double x, double y, double angle, double mass) {
  const std::string name = numbered("rod", i);
  return body(name, "mass = " + number(mass) + "; inertia = " + number(mass / 12.0) + "; position = " + point(x, y) +
                        "; angle = " + number(angle)) +
         element("revolute", numbered("pin", i),
                 "a = " + at(name, -0.5, 0.0) + "; b = " + (i == 0 ? at("ground", 0.0, 0.0) : at(numbered("rod", i - 1), 0.5, 0.0)));
}

// Foot i on what carries it: two contacts and their friction.
std::string feet(int i, const std::string& on, double width, double height, double stiffness) {
  const std::string name = numbered("block", i), left = numbered("left", i), right = numbered("right", i);
  std::string text;
  for (const auto& [foot, x] : {std::pair{left, -width}, {right, width}})
    text += element("unilateral_contact", foot,
                    "a = " + at(name, x, -height) + "; b = " + on + "; stiffness = " + number(stiffness) + "; damping = 1e3");
  return text + element("coulomb_stick", numbered("friction", i),
                        "contacts = [" + quoted(left) + ", " + quoted(right) + "]; static_friction = 0.4");
}

} // namespace

TEST_CASE("sparse algebra finds the rests that dense algebra finds") {
  for (const char* name :
       {"benchmarks/double_pendulum", "benchmarks/chain_10", "benchmarks/slider_crank", "benchmarks/robot_arm", "benchmarks/four_bar_2",
        "benchmarks/andrews", "paper/no_interference", "paper/interference", "layouts/rail_wagon_humping"}) {
    CAPTURE(std::string(name));
    const Model model = read_model(std::string(STEPLAP_MODELS) + "/" + name + ".toml", transformer_catalog());
    const Found dense = settle(model, RestAlgebra::dense), sparse = settle(model, RestAlgebra::sparse);
    REQUIRE(dense.rest.state.q.size() == sparse.rest.state.q.size());
    CHECK(sparse.rest.residual < 1e-8); // as the dense one, equilibrium_test.cpp
    // Both end where Newton's steps are 1e-11 of a scene of metres; friction holds what it got on the way, up to its share
    // of a load that differs by what is left then.
    for (std::size_t i = 3; i < dense.rest.state.q.size(); ++i) CHECK(std::abs(dense.rest.state.q[i] - sparse.rest.state.q[i]) < 1e-9);
    if (std::string(name) != "layouts/rail_wagon_humping") // known: one of its two is not counted (docs/explanation/theory.md, Rest)
      CHECK(dense.rest.indifferent.size() == sparse.rest.indifferent.size());
    REQUIRE(dense.rest.margins.size() == sparse.rest.margins.size());
    for (std::size_t i = 0; i < dense.rest.margins.size(); ++i)
      CHECK(sparse.rest.margins[i].used == doctest::Approx(dense.rest.margins[i].used).epsilon(1e-6));
  }
}

// As in equilibrium_test.cpp: tan φ_i = (i − (n − 1)/2) w/H, H from the span, from a roof over the supports.
TEST_CASE("a long chain between two supports takes the catenary's shape from far off") {
  for (const int n : {200, 600}) {
    CAPTURE(n);
    const double w = 2.0 * k_g, share = 0.7, roof = std::acos(share);
    const auto slope = [&](int i, double h) { return (i - 0.5 * (n - 1)) * w / h; };
    double low = 1e-3, high = 1e8;
    for (int k = 0; k < 200; ++k) {
      const double h = 0.5 * (low + high);
      double width = 0.0;
      for (int i = 0; i < n; ++i) width += 1.0 / std::hypot(1.0, slope(i, h));
      (width < share * n ? low : high) = h;
    }
    std::string text;
    for (int i = 0; i < n; ++i)
      text += rod(i, share * (i + 0.5), std::min(i + 0.5, n - i - 0.5) * std::sin(roof), i < n / 2 ? roof : -roof, 2.0);
    text += element("revolute", "end", "a = " + at(numbered("rod", n - 1), 0.5, 0.0) + "; b = " + at("ground", share * n, 0.0));
    const Found found = settle(text);
    double x = 0.0, y = 0.0, worst = 0.0, worst_angle = 0.0;
    for (int i = 0; i < n; ++i) {
      const double angle = std::atan(slope(i, low));
      worst = std::max(
          {worst, std::abs(found.q(i + 1, 0) - x - 0.5 * std::cos(angle)), std::abs(found.q(i + 1, 1) - y - 0.5 * std::sin(angle))});
      worst_angle = std::max(worst_angle, std::abs(found.q(i + 1, 2) - angle));
      x += std::cos(angle);
      y += std::sin(angle);
    }
    // Newton's last step is below 1e-11 of a length of 0.7 n, and each of n joints is met to rounding of as much.
    CHECK(worst < 1e-11 * n);
    CHECK(worst_angle < 1e-11 * n);
  }
}

// It balances there, in 2⁶⁰ ways: the straight one is left, and the hanging one is the only one that holds.
TEST_CASE("a chain stood on its end falls until it hangs") {
  std::string text;
  const int n = 60;
  for (int i = 0; i < n; ++i) text += rod(i, 0.0, i + 0.5, 0.5 * k_pi, 1.0);
  const Found found = settle(text);
  CHECK_FALSE(found.rest.left.empty());
  for (int i = 0; i < n; ++i) {
    CHECK(std::abs(found.q(i + 1, 0)) < 1e-9);
    CHECK(std::abs(found.q(i + 1, 1) + i + 0.5) < 1e-9); // 1e-11 of 60 m
  }
}

// Column i of n masses on bushings k, its neighbours alike: the lowest spring bears n weights, the next n − 1 …
TEST_CASE("a grid of masses on springs settles by the weight above each spring") {
  const int n = 24;
  const double k = 1e4, m = 1.5;
  const std::string stiff = "; stiffness = [1e4, 1e4]; rotational_stiffness = 1e3";
  std::string text;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::string name = numbered(numbered("mass", i), j);
      text += body(name, "mass = 1.5; inertia = 0.1; position = " + point(i, j + 1));
      text +=
          element("bushing", "up " + name,
                  "a = " + quoted(name) + "; b = " + (j > 0 ? quoted(numbered(numbered("mass", i), j - 1)) : at("ground", i, 0.0)) + stiff);
      if (i > 0)
        text += element("bushing", "side " + name, "a = " + quoted(name) + "; b = " + quoted(numbered(numbered("mass", i - 1), j)) + stiff);
    }
  const Found found = settle(text);
  double worst = 0.0;
  for (int i = 0; i < n; ++i) {
    double y = 0.0;
    for (int j = 0; j < n; ++j) {
      y += 1.0 - (n - j) * m * k_g / k;
      worst = std::max({worst, std::abs(found.q(1 + i * n + j, 0) - i), std::abs(found.q(1 + i * n + j, 1) - y)});
    }
  }
  CHECK(worst < 1e-10 * n); // 1e-11 of the length, in each of two directions and some
  CHECK(found.rest.indifferent.empty());
}

TEST_CASE("a large scene that nothing holds is said to have no rest") {
  const int n = 300;
  std::string text;
  for (int i = 0; i < n; ++i) {
    text += body(numbered("mass", i), "mass = 2; inertia = 0.1; position = " + point(i, 0.0));
    if (i > 0)
      text += element("bushing", numbered("side", i),
                      "a = " + quoted(numbered("mass", i)) + "; b = " + quoted(numbered("mass", i - 1)) +
                          "; stiffness = [1e4, 1e4]; rotational_stiffness = 1e3");
  }
  const std::string why = reason(text);
  CAPTURE(why);
  CHECK(why.find("' along -y moves without end: nothing holds it against the 19.62 N") != std::string::npos);
}

// Blocks of 10 kg on a deck of 1 t on two springs of 1e7 N/m: the deck sinks by all of them, each block by its own feet.
TEST_CASE("a row of 200 blocks comes to rest on a deck that gives way under them") {
  const int n = 200;
  std::string text = body("deck", "mass = 1000; inertia = 1e5");
  for (const double x : {-120.0, 120.0})
    text += element("bushing", x < 0.0 ? "rear" : "front",
                    "a = " + at("deck", x, 0.0) + "; b = " + at("ground", x, 0.0) + "; stiffness = [1e7, 1e7]");
  for (int i = 0; i < n; ++i)
    text +=
        body(numbered("block", i), "mass = 10; inertia = 1.67; position = " + point(1.2 * (i - 0.5 * (n - 1)), 0.52 + 0.001 * (i % 7))) +
        feet(i, quoted("deck"), 0.5, 0.5, 1e6);
  const Found found = settle(text);
  CHECK(found.rest.iterations < 20); // they land in one step, each where it touches, not one after another
  const double deck = -(1000.0 + 10.0 * n) * k_g / 2e7;
  CHECK(std::abs(found.q(1, 1) - deck) < 1e-9); // 1e-11 of 240 m
  REQUIRE(found.rest.margins.size() == static_cast<std::size_t>(n));
  const double tilt = found.q(1, 2); // blocks that landed one after another: what friction holds may tilt the deck
  CHECK(std::abs(tilt) < 1e-6);
  for (int i = 0; i < n; ++i) {
    const double sunk = 10.0 * k_g / 2e6, x = found.q(i + 2, 0);
    CHECK(std::abs(found.q(i + 2, 1) - deck - x * tilt - 0.5 + sunk) < 3e-9); // the same, twice, and 120 m times tilt² / 2
    CHECK(found.rest.margins[static_cast<std::size_t>(i)].used < 0.01);
  }
}

// Each is pushed with 0.6 of its weight, friction bears 0.4 of it, a spring the rest: 0.2 m g/k further on. Friction that
// slides follows the normal forces, so that the stiffness is not symmetric.
TEST_CASE("sixty blocks slide until springs and friction hold them") {
  const int n = 60;
  std::string text;
  for (int i = 0; i < n; ++i) {
    const std::string name = numbered("block", i);
    text += body(name, "mass = 100; inertia = 10; position = " + point(3.0 * i, 0.2)) + feet(i, quoted("ground"), 0.5, 0.2, 1e6) +
            element("bushing", numbered("spring", i),
                    "a = " + quoted(name) + "; b = " + at("ground", 3.0 * i, 0.2) + "; stiffness = [1e4, 0.0]") +
            element("load", numbered("push", i), "at = " + quoted(name) + "; force = [588.6, 0.0]");
  }
  const Found found = settle(text);
  CHECK(found.rest.slid.size() == static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) { // friction is short of its bound by a millionth (statics.cpp), 4e-4 N of 1e4 N/m
    CHECK(std::abs(found.q(i + 1, 0) - 3.0 * i - 0.2 * 100.0 * k_g / 1e4) < 1e-7);
    CHECK(std::abs(found.q(i + 1, 1) - 0.2 + 100.0 * k_g / 2e6) < 1e-7);
  }
}

TEST_CASE("wheels that nothing turns are indifferent, however many") {
  std::string text;
  const int n = 50;
  for (int i = 0; i < n; ++i)
    text += body(numbered("wheel", i), "mass = 2; inertia = 1; position = " + point(i, 0.0)) +
            element("revolute", numbered("pin", i), "a = " + quoted(numbered("wheel", i)));
  const Found found = settle(text);
  for (const MotionPart& part : found.rest.indifferent) CHECK(part.coordinate == 2);
  CHECK(static_cast<int>(found.rest.indifferent.size()) + found.rest.more_indifferent == n);
  CHECK(found.rest.residual < 1e-12); // rounding of 9.81 m/s²
}

// A path of springs between its ends: the negative directions of A − σ along rows are known. A = tridiag(−1, 2, −1) in x
// has eigenvalues 2 − 2 cos(kπ/(n + 1)); y and θ are held by rows, some of them twice.
TEST_CASE("signs of pivots count the negative directions that rows allow, and solutions meet them") {
  const int n = 40;
  std::vector<Eigen::Triplet<double, int>> entries;
  std::vector<SparseRow> rows;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(3 * i, 3 * i, 2.0);
    for (const int j : {i - 1, i + 1})
      if (j >= 0 && j < n) entries.emplace_back(3 * i, 3 * j, -1.0);
    for (const int c : {1, 2, 2}) {
      SparseRow row;
      row.count = 3;
      for (int k = 0; k < 3; ++k) row.at[k] = 3 * i + k;
      row.j[c] = 1.0;
      rows.push_back(row);
    }
  }
  BorderedSystem::Sparse a(3 * n, 3 * n);
  a.setFromTriplets(entries.begin(), entries.end());
  BorderedSystem system;
  system.set(a, rows, VecX::Ones(3 * n));
  for (const double sigma : {0.0, -0.1, -1.03, -2.7, -4.5, 1.0}) {
    CAPTURE(sigma);
    int below = 0;
    for (int k = 1; k <= n; ++k) below += 2.0 - 2.0 * std::cos(k * k_pi / (n + 1)) + sigma < 0.0 ? 1 : 0;
    REQUIRE(system.factor(sigma));
    CHECK(system.negative() == below);
    VecX force = VecX::LinSpaced(3 * n, -1.0, 2.0), x;
    REQUIRE(system.solve(force, x));
    VecX left = a * x + sigma * x - force;
    double off = 0.0, out = 0.0;
    for (int i = 0; i < n; ++i) {
      out = std::max(out, std::abs(left[3 * i]));
      off = std::max({off, std::abs(x[3 * i + 1]), std::abs(x[3 * i + 2])});
    }
    CHECK(out < 1e-10); // rounding by the condition, at most 1e4 here
    CHECK(off < 1e-10);
  }
}
