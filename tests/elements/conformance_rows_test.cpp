// The conformance suite, second part: constraint rows and friction.
#include "tests/elements/conformance_probe.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numeric>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr int k_draws = 60;
constexpr double k_rounding = 1e-12; // of lengths of a metre

template <class Check> void for_each_row(const Check& check) {
  for (const ConformanceScene& scene : conformance_scenes()) {
    CAPTURE(std::string(scene.kind));
    CAPTURE(std::string(scene.text));
    Probe probe(scene);
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      const Pose pose = poses.next();
      for (const RowSpec& row : probe.rows()) check(probe, row, pose);
    }
  }
}

} // namespace

TEST_CASE("conformance: gradient, rate and bias of rows against differences") {
  for_each_row([](Probe& probe, const RowSpec& row, const Pose& pose) {
    const MeasureValue<double> m = probe.row(row, pose);
    const Vec9 gradient = gradient_of(row, m);
    const double h = 1e-5; // truncation h²/6·f''' ~ 1e-10, rounding 1e-16/h = 1e-11
    for (int i = 0; i < 9; ++i) {
      Pose ahead = pose, behind = pose;
      ahead.q[i] += h;
      behind.q[i] -= h;
      const double slope = (probe.row(row, ahead).value - probe.row(row, behind).value) / (2.0 * h);
      CHECK(std::abs(slope - gradient[i]) < 1e-8);
    }
    CHECK(std::abs(m.rate - gradient.dot(pose.v)) < k_rounding);
    // Second difference along constant velocities, h = 1e-4: truncation h²/12·f'''' ~ 1e-7 (distances of a
    // third of a metre), rounding 1e-16/h² = 1e-8.
    const auto value = [&](double t) {
      Pose p = pose;
      p.q += t * pose.v;
      return probe.row(row, p).value;
    };
    const double k = 1e-4, second = (value(k) - 2.0 * value(0.0) + value(-k)) / (k * k);
    CHECK(std::abs(second - m.bias) < 2e-6 * (1.0 + std::abs(m.bias)));
  });
}

TEST_CASE("conformance: a row's force acts at one point of both bodies") {
  for_each_row([](Probe& probe, const RowSpec& row, const Pose& pose) {
    const MeasureValue<double> m = probe.row(row, pose);
    const Vec9 g = gradient_of(row, m);
    Vec2 sum = Vec2::Zero();
    double moment = 0.0;
    for (int i = 0; i < 3; ++i) {
      sum += g.segment<2>(3 * i);
      moment += g[3 * i + 2] + cross(Vec2(pose.q.segment<2>(3 * i)), Vec2(g.segment<2>(3 * i)));
    }
    CHECK(sum.norm() < k_rounding);
    CHECK(std::abs(moment) < k_rounding);
  });
}

TEST_CASE("conformance: rows do not care where the scene is, and mirror with it") {
  for_each_row([](Probe& probe, const RowSpec& row, const Pose& pose) {
    const MeasureValue<double> here = probe.row(row, pose);
    const MeasureValue<double> there = probe.row(row, moved(pose, 1.234, {7.0, -3.0}));
    CHECK(std::abs(here.value - there.value) < 1e-11); // rounding of positions of 7 m, more than one term
    CHECK(std::abs(here.rate - there.rate) < 1e-11);
    CHECK((gradient_of(row, there) - turned(gradient_of(row, here), 1.234)).norm() < 1e-11);
  });
  for (const ConformanceScene& scene : conformance_scenes()) {
    CAPTURE(std::string(scene.kind));
    Probe probe(scene), mirror(scene, true);
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      const Pose pose = poses.next();
      const Pose image{mirrored(pose.q), mirrored(pose.v)};
      const std::vector<RowSpec> rows = probe.rows(), images = mirror.rows();
      REQUIRE(rows.size() == images.size());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        // Rear and front foot, a line's left and right side change places; the row along x or t changes its
        // sign, the one along y does not.
        const bool is_slide = rows[r].kind == MeasureKind::slide || rows[r].kind == MeasureKind::roll_line;
        const RowSpec& twin = images[is_slide ? rows.size() - 1 - r : r];
        const auto m = probe.row(rows[r], pose);
        const auto n = mirror.row(twin, image);
        const Vec9 g = gradient_of(twin, n), expected = mirrored(gradient_of(rows[r], m));
        const double sign = g.dot(expected) > 0.0 ? 1.0 : -1.0;
        CHECK((g - sign * expected).norm() < k_rounding);
        CHECK(std::abs(n.rate - sign * m.rate) < k_rounding);
        CHECK(std::abs(n.bias - sign * m.bias) < 1e-11);
      }
    }
  }
}

TEST_CASE("conformance: one-dimensional friction opposes slip, and its sets and watch values agree") {
  for (const ConformanceScene& scene : conformance_scenes()) {
    if (std::string(scene.kind) != "coulomb_stick") continue;
    Probe probe(scene);
    RandomPoses poses(probe.system());
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const FrictionElement& friction = *probe.system().frictions[0].friction;
    for (int i = 0; i < 200; ++i) {
      const Pose pose = poses.next();
      probe.choose_modes(pose);
      probe.forces(pose);
      const Evaluation& e = probe.evaluation();
      const double normal = std::max(0.0, std::accumulate(e.contact_force, e.contact_force + probe.system().contact_count, 0.0));
      FrictionState state;
      double rate = unit(generator), wrench = 0.0, watch[2];
      friction.aim(state, &rate);
      friction.slip_wrench(e, state, &rate, &wrench);
      CHECK(wrench * rate <= 0.0);
      CHECK(std::abs(wrench) == doctest::Approx(0.3 * normal));
      friction.watch_slip(e, state, &rate, watch);
      CHECK(watch[0] >= 0.0);
      for (const double share : {-1.01, -0.99, 0.0, 0.99, 1.01}) {
        wrench = share * 0.4 * normal;
        friction.watch_stick(e, state, &wrench, watch);
        CHECK((std::min(watch[0], watch[1]) >= 0.0) == (std::abs(share) <= 1.0 || normal == 0.0));
        if (std::abs(share) > 1.0 && normal > 0.0) {
          FrictionState begun = state;
          friction.begin_slip(e, begun, &wrench);
          double onset = 0.0, still = 0.0;
          friction.slip_wrench(e, begun, &still, &onset);
          CHECK(onset * wrench > 0.0); // the force goes on in the direction in which it held
        }
      }
      // min ½ a w² + b w over |w| ≤ bound: the clipped stationary point, and the acceleration left over.
      const double a = 0.5 + std::abs(unit(generator)), b = 30.0 * unit(generator);
      for (const bool is_kinetic : {false, true}) {
        const double bound = (is_kinetic ? 0.3 : 0.4) * normal;
        const FrictionBlock block = friction.solve_block(e, state, &a, &b, is_kinetic);
        CHECK(std::abs(block.wrench[0]) <= bound);
        const double left = a * block.wrench[0] + b;
        if (block.is_inside) CHECK(std::abs(left) < 1e-9);
        else {
          CHECK(std::abs(block.wrench[0]) == bound);
          CHECK(left * block.direction[0] >= 0.0);
          CHECK(block.wrench[0] * block.direction[0] <= 0.0);
        }
      }
    }
  }
}
