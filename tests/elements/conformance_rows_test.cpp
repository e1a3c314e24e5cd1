// The conformance suite, second part: constraint rows and friction.
#include "tests/elements/conformance_probe.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <random>

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
      CHECK(std::abs(slope - (row.kind == MeasureKind::skate ? 0.0 : gradient[i])) < 1e-8); // a skate's value says nothing
    }
    CHECK(std::abs(m.rate - gradient.dot(pose.v)) < k_rounding);
    if (row.kind == MeasureKind::skate) {
      const auto rate = [&](double t) {
        Pose p = pose;
        p.q += t * pose.v;
        return probe.row(row, p).rate;
      };
      CHECK(std::abs((rate(h) - rate(-h)) / (2.0 * h) - m.bias) < 1e-8 * (1.0 + std::abs(m.bias)));
      return;
    }
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

namespace {

// Bounds of one-dimensional friction in the scenes, static and kinetic, on the side on which `wrench` lies; of three dimensions only their
// ratio, 1.
struct Bounds {
  double stick = 0.0, slip = 0.0;
};

Bounds bounds_of(const ConformanceScene& scene, const Probe& probe, double wrench) {
  if (std::string(scene.kind) == "freewheel") return wrench < 0.0 ? Bounds{2.0, 2.0} : Bounds{5.0, 5.0};
  if (std::string(scene.kind) == "joint_friction")
    return std::string(scene.text).find("drags") == std::string::npos ? Bounds{30.0, 30.0} : Bounds{3.0, 2.0};
  if (std::string(scene.kind) == "skate") return {30.0, 20.0};
  const Evaluation& e = probe.evaluation();
  if (std::string(scene.kind) == "buffer") { // half of 900 d less 300 d, d = 0.05 m in the reference pose
    const State start = probe.system().initial_state();
    std::vector<Motion<double>> reference;
    place_bodies(start.q, start.v, reference);
    const RowSpec& row = *probe.system().frictions[0].friction->rows(start.friction[0]);
    const double grown = evaluate_row<false>(row, e.motion).value - evaluate_row<false>(row, reference.data()).value;
    const double half = std::max(0.0, 300.0 * (0.05 - grown)) + 1e-12; // a depth has the rounding of two lengths
    return {half, half};
  }
  if (std::string(scene.kind) == "lossy_gear") { // 1/0.8 − 1 of the couple of its teeth
    const Motion<double>&a = e.motion[1], &b = e.motion[2];
    const double couple = 90.0 * ((a.theta - 0.2) + 2.5 * (b.theta + 0.1)) + 3.0 * (a.omega + 2.5 * b.omega),
                 bound = 0.25 * (std::abs(couple) + 1e-10); // rounding of the couple
    return {bound, bound};
  }
  const double normal = std::max(0.0, std::accumulate(e.contact_force, e.contact_force + probe.system().contact_count, 0.0));
  if (std::string(scene.kind) == "rolling_resistance") return {0.02 * normal, 0.02 * normal};
  return {0.4 * normal, 0.3 * normal};
}

template <class Check> void for_each_friction(const Check& check) {
  int count = 0;
  for (const ConformanceScene& scene : conformance_scenes()) {
    CAPTURE(std::string(scene.kind));
    CAPTURE(std::string(scene.text));
    Probe probe(scene);
    if (probe.system().frictions.empty()) continue;
    const FrictionElement& friction = *probe.system().frictions[0].friction;
    if (friction.never_slips() || friction.is_elastic()) continue; // a joint without sheets, or one whose wrench is a spring's
    ++count;
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      Pose pose = poses.next();
      // Holding sheets overlap as they did where they began to hold, here in the reference pose.
      if (friction.dimension() == 3)
        for (int body = 0; body < 3; ++body) pose.q.segment<3>(3 * body) = probe.system().bodies[body].pose;
      probe.choose_modes(pose);
      probe.forces(pose);
      check(scene, probe, friction);
    }
  }
  // Three coulomb_stick, two polygon_contact, a step_lap_joint with sheets, two joint_friction, a buffer, a freewheel, a lossy gear, a skate, a bearing, two
  // rolling_resistance.
  CHECK(count == 15);
}

using Wrench = std::array<double, 3>;

double dot(const Wrench& a, const Wrench& b, int n) { return std::inner_product(a.begin(), a.begin() + n, b.begin(), 0.0); }

class Draw {
public:
  Wrench wrench(double size) { return {size * unit_(generator_), size * unit_(generator_), size * unit_(generator_)}; }
  double number() { return unit_(generator_); }

private:
  std::mt19937 generator_{7};
  std::uniform_real_distribution<double> unit_{-1.0, 1.0};
};

} // namespace

TEST_CASE("conformance: friction opposes slip, with all that its set allows") {
  Draw draw;
  for_each_friction([&](const ConformanceScene& scene, const Probe& probe, const FrictionElement& friction) {
    const Evaluation& e = probe.evaluation();
    const int n = friction.dimension();
    FrictionState state;
    const Wrench rate = draw.wrench(1.0), other = draw.wrench(1.0);
    Wrench wrench{}, event_value{};
    friction.aim(state, rate.data());
    friction.slip_wrench(e, state, rate.data(), wrench.data());
    const double power = -dot(wrench, rate, n), most = friction.support(e, state, rate.data());
    CHECK(power >= 0.0);
    if (n == 1) {
      const Bounds b = bounds_of(scene, probe, wrench[0]);
      CHECK(std::abs(wrench[0]) == doctest::Approx(b.slip));
      CHECK(most == doctest::Approx(b.stick * std::abs(rate[0])));
    } else {
      CHECK(power == doctest::Approx(most).epsilon(1e-9)); // both coefficients are the same: −∇h(ν)·ν = h(ν)
    }
    friction.slip_events(e, state, rate.data(), event_value.data());
    CHECK(event_value[0] >= 0.0);
    // h is homogeneous and convex.
    Wrench twice{}, sum{};
    for (int k = 0; k < 3; ++k) {
      twice[k] = 2.0 * rate[k];
      sum[k] = rate[k] + other[k];
    }
    CHECK(friction.support(e, state, twice.data()) == doctest::Approx(2.0 * most).epsilon(1e-12));
    CHECK(friction.support(e, state, sum.data()) <= (most + friction.support(e, state, other.data())) * (1.0 + 1e-12));
  });
}

TEST_CASE("conformance: the set, its gauge and the watch values agree") {
  Draw draw;
  for_each_friction([&](const ConformanceScene&, const Probe& probe, const FrictionElement& friction) {
    const Evaluation& e = probe.evaluation();
    const int n = friction.dimension();
    FrictionState state;
    Wrench w = draw.wrench(100.0), rate = draw.wrench(1.0), normal{}, ignored{};
    if (!(friction.support(e, state, rate.data()) > 0.0)) return; // no contact pressed
    const double usage = friction.gauge(e, state, w.data(), normal.data());
    CHECK(dot(normal, w, n) == doctest::Approx(usage).epsilon(1e-9));
    const Wrench another = draw.wrench(100.0);
    CHECK(dot(normal, another, n) <= friction.gauge(e, state, another.data(), ignored.data()) * (1.0 + 1e-9));
    for (const double share : {0.0, 0.99, 1.01}) {
      Wrench scaled{}, event_value{1.0, 1.0, 1.0};
      for (int k = 0; k < n; ++k) scaled[k] = share / usage * w[k];
      friction.stick_events(e, state, scaled.data(), event_value.data());
      CHECK((std::min(event_value[0], event_value[1]) >= 0.0) == (share <= 1.0));
      CHECK((-dot(scaled, rate, n) <= friction.support(e, state, rate.data())) >= (share <= 1.0)); // it takes no more than h
      if (share <= 1.0) continue;
      FrictionState begun = state;
      begun.is_onset = true;
      friction.set_onset_direction(e, begun, scaled.data());
      Wrench onset{};
      const Wrench still{};
      friction.slip_wrench(e, begun, still.data(), onset.data());
      CHECK(dot(onset, scaled, n) > 0.0); // the force goes on in the direction in which it held
    }
  });
}

// min ½ wᵀA w + bᵀw over the set: a stationary point inside, or on the bound with A w + b in its normal cone, which a
// wrench w' of the set proves by (A w + b)·(w' − w) ≥ 0.
TEST_CASE("conformance: the mode problem's blocks are solved") {
  Draw draw;
  for_each_friction([&](const ConformanceScene& scene, const Probe& probe, const FrictionElement& friction) {
    const Evaluation& e = probe.evaluation();
    const int n = friction.dimension();
    FrictionState state;
    double a[9] = {0.5 + std::abs(draw.number())};
    if (n == 3) { // positive definite: G Gᵀ and a diagonal
      double g[9];
      for (double& value : g) value = draw.number();
      for (int i = 0; i < 9; ++i)
        a[i] = g[3 * (i / 3)] * g[3 * (i % 3)] + g[3 * (i / 3) + 1] * g[3 * (i % 3) + 1] + g[3 * (i / 3) + 2] * g[3 * (i % 3) + 2];
      for (int i = 0; i < 3; ++i) a[4 * i] += 0.5;
    }
    const double size = n == 1 ? 30.0 : 3000.0;
    const Wrench b = draw.wrench(size);
    for (const bool is_kinetic : {false, true}) {
      const BlockSolution block = friction.solve_block(e, state, a, b.data(), is_kinetic);
      Wrench left{}, w{}, ignored{};
      for (int r = 0; r < n; ++r) {
        w[r] = block.wrench[r];
        left[r] = b[r];
        for (int c = 0; c < n; ++c) left[r] += a[n * r + c] * block.wrench[c];
      }
      const double slack = 1e-8 * size;
      if (n == 1) CHECK(std::abs(w[0]) <= (is_kinetic ? bounds_of(scene, probe, w[0]).slip : bounds_of(scene, probe, w[0]).stick));
      else CHECK(friction.gauge(e, state, w.data(), ignored.data()) <= 1.0 + 1e-8);
      if (block.sticks) {
        CHECK(std::sqrt(dot(left, left, n)) < slack);
        continue;
      }
      CHECK(dot(w, Wrench{block.direction[0], block.direction[1], block.direction[2]}, n) <= 0.0);
      // The worst w' of the set against `left` is what it bears against −left: left·w' ≥ −h(left).
      const double share =
          n == 1 && is_kinetic ? bounds_of(scene, probe, w[0]).slip / std::max(bounds_of(scene, probe, w[0]).stick, 1e-300) : 1.0;
      const double bound = share * friction.support(e, state, left.data());
      CHECK(std::abs(dot(left, w, n) + bound) <= 1e-7 * (bound + slack));
    }
  });
}
