// The conformance suite over the whole catalogue: what every element that gives forces must obey.
#include "tests/elements/conformance_probe.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

constexpr int k_draws = 60;
// Central differences with this step: truncation h²/6·f''' ~ 1e-11 f, rounding 1e-16 f/h = 1e-11 f. Forces
// and their derivatives here are of the order 10 to 1000, third derivatives of lengths 1/(0.3 m)³.
constexpr double k_step = 1e-5;
constexpr double k_difference = 1e-6;
// Identities that hold term by term: rounding of numbers of the order 1000.
constexpr double k_rounding = 1e-11;

// A draw on which a law changes its piece within the differences' reach tells nothing; and depth^1.5 has
// third derivatives without bound where it starts.
bool is_near_kink(Probe& probe, const Pose& pose) {
  probe.forces(pose);
  for (const double w : probe.event_value())
    if (std::abs(w) < 4e-3) return true;
  return false;
}

template <class Check> void for_each_draw(bool is_mirrored, const Check& check) {
  for (const ConformanceScene& scene : conformance_scenes()) {
    CAPTURE(std::string(scene.kind));
    CAPTURE(std::string(scene.text));
    Probe probe(scene, is_mirrored);
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      const Pose pose = poses.next();
      if (scene.kind == std::string("unilateral_contact")) probe.start_at(pose); // those with ends remember how they came
      else probe.choose_modes(pose);
      if (!is_near_kink(probe, pose)) check(scene, probe, pose);
    }
  }
}

template <class F> Vec9 gradient(const Pose& pose, const F& f) {
  Vec9 g;
  for (int i = 0; i < 9; ++i) {
    Pose ahead = pose, behind = pose;
    ahead.q[i] += k_step;
    behind.q[i] -= k_step;
    g[i] = (f(ahead) - f(behind)) / (2.0 * k_step);
  }
  return g;
}

} // namespace

TEST_CASE("conformance: every kind of the catalogue has a scene, and all of its modes occur") {
  for (const ElementKind* kind : element_catalog().elements) {
    CAPTURE(kind->name);
    CHECK(std::any_of(conformance_scenes().begin(), conformance_scenes().end(),
                      [&](const ConformanceScene& scene) { return scene.kind == kind->name; }));
  }
  for (const ConformanceScene& scene : conformance_scenes()) {
    if (std::string(scene.kind).find("_contact") == std::string::npos) continue;
    Probe probe(scene);
    RandomPoses poses(probe.system());
    int seen = 0;
    for (int i = 0; i < k_draws; ++i) {
      probe.start_at(poses.next());
      seen |= 1 << probe.state().mode[0];
    }
    CAPTURE(std::string(scene.text));
    CHECK((seen & 3) == 3); // open and pressed; released needs a fast parting
  }
}

TEST_CASE("conformance: at rest the force is minus the gradient of the potential energy") {
  for_each_draw(false, [](const ConformanceScene& scene, Probe& probe, Pose pose) {
    if (std::string(scene.kind) == "load" || std::string(scene.kind) == "motor" || std::string(scene.kind) == "force")
      return; // have no potential
    pose.v.setZero();
    if (scene.kind == std::string("unilateral_contact")) probe.start_at(pose);
    else probe.choose_modes(pose);
    if (is_near_kink(probe, pose)) return;
    if (scene.kind == std::string("tyre") ||
        std::string(scene.text).find("\"tyre\"") !=
            std::string::
                npos) { // bristles in the air lose what they store; slides and inclines against the tread's coordinate have no potential
      constexpr UnitMode k_presses_and_adheres = 1;
      if ((probe.state().mode[0] & 15U) != k_presses_and_adheres || std::string(scene.text).find("road") != std::string::npos) return;
    }
    const Vec9 expected = -gradient(pose, [&](const Pose& p) { return probe.potential(p); });
    CHECK((probe.forces(pose) - expected).norm() < k_difference * (1.0 + expected.norm()));
  });
}

TEST_CASE("conformance: power of the forces, change of potential, dissipation and work balance") {
  for_each_draw(false, [](const ConformanceScene&, Probe& probe, const Pose& pose) {
    const double power = probe.forces(pose).dot(pose.v);
    const double dissipation = probe.evaluation().dissipation, work = probe.evaluation().work;
    const std::vector<double> inner = probe.state().inner, inner_rate = probe.inner_rates();
    const auto potential_at = [&](double t) { // inner states move, too
      Pose p = pose;
      p.q += t * pose.v;
      for (std::size_t i = 0; i < inner.size(); ++i) probe.state().inner[i] = inner[i] + t * inner_rate[i];
      const double energy = probe.potential(p);
      probe.state().inner = inner;
      return energy;
    };
    const double stored = (potential_at(k_step) - potential_at(-k_step)) / (2.0 * k_step);
    CHECK(std::abs(power + stored + dissipation - work) < k_difference * (1.0 + std::abs(power) + std::abs(stored)));
    CHECK(dissipation >= 0.0);
  });
}

TEST_CASE("conformance: action equals reaction, as force and as moment about any point") {
  for_each_draw(false, [](const ConformanceScene& scene, Probe& probe, const Pose& pose) {
    if (scene.is_external) return;
    const Vec9 f = probe.forces(pose);
    Vec2 sum = Vec2::Zero();
    double moment = 0.0;
    for (int i = 0; i < 3; ++i) {
      sum += f.segment<2>(3 * i);
      moment += f[3 * i + 2] + cross(Vec2(pose.q.segment<2>(3 * i)), Vec2(f.segment<2>(3 * i)));
    }
    CHECK(sum.norm() < k_rounding);
    CHECK(std::abs(moment) < k_rounding);
  });
}

TEST_CASE("conformance: moving and turning the whole scene moves and turns the forces, no more") {
  for_each_draw(false, [](const ConformanceScene& scene, Probe& probe, const Pose& pose) {
    if (scene.is_external && std::string(scene.text).find("frame") == std::string::npos) return;
    const double angle = 1.234;
    const Vec9 f = probe.forces(pose);
    const double energy = probe.potential(pose);
    const Pose elsewhere = moved(pose, angle, {7.0, -3.0});
    const Vec9 g = probe.forces(elsewhere);
    // Rounding of positions of 7 m, times stiffness: 1e-15 · 1000.
    CHECK((g - turned(f, angle)).norm() < 1e-10 * (1.0 + f.norm()));
    CHECK(std::abs(probe.potential(elsewhere) - energy) < 1e-10 * (1.0 + std::abs(energy)));
  });
}

TEST_CASE("conformance: the mirrored scene gives mirrored forces") {
  for (const ConformanceScene& scene : conformance_scenes()) {
    CAPTURE(std::string(scene.kind));
    CAPTURE(std::string(scene.text));
    Probe probe(scene), mirror(scene, true);
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      const Pose pose = poses.next();
      const Pose image{mirrored(pose.q), mirrored(pose.v)};
      if (scene.kind == std::string("unilateral_contact")) {
        probe.start_at(pose);
        mirror.start_at(image);
      } else {
        probe.choose_modes(pose);
        mirror.choose_modes(image);
      }
      CHECK((mirror.forces(image) - mirrored(probe.forces(pose))).norm() < k_rounding);
      CHECK(std::abs(mirror.potential(image) - probe.potential(pose)) < k_rounding);
    }
  }
}

TEST_CASE("conformance: naming the bodies the other way round changes nothing where the law does not care") {
  for (const ConformanceScene& scene : conformance_scenes()) {
    if (!scene.is_reversible) continue;
    CAPTURE(std::string(scene.kind));
    Probe probe(scene), swapped(scene, false, true);
    RandomPoses poses(probe.system());
    for (int i = 0; i < k_draws; ++i) {
      const Pose pose = poses.next();
      probe.choose_modes(pose);
      swapped.choose_modes(pose);
      CHECK((swapped.forces(pose) - probe.forces(pose)).norm() < k_rounding);
      for (std::size_t r = 0; r < probe.rows().size(); ++r) {
        const RowSpec one = probe.rows()[r], other = swapped.rows()[r];
        CHECK((gradient_of(one, probe.row(one, pose)) - gradient_of(other, swapped.row(other, pose))).norm() < k_rounding);
      }
    }
  }
}

TEST_CASE("conformance: stiffness and damping matrices against differences of the forces") {
  for_each_draw(false, [](const ConformanceScene&, Probe& probe, const Pose& pose) {
    probe.forces(pose);
    std::vector<PairJacobian> parts;
    for (const auto& group : probe.system().groups) group->add_jacobian(probe.evaluation(), parts);
    Eigen::Matrix<double, 9, 9> by_q = Eigen::Matrix<double, 9, 9>::Zero(), by_v = by_q;
    for (const PairJacobian& p : parts)
      for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k) {
          const int row = 3 * (i < 3 ? p.a : p.b) + i % 3, column = 3 * (k < 3 ? p.a : p.b) + k % 3;
          by_q(row, column) += p.stiffness(i, k);
          by_v(row, column) += p.damping(i, k);
        }
    for (int k = 0; k < 9; ++k)
      for (const bool is_velocity : {false, true}) {
        if (k < 3) continue; // the ground does not move
        Pose ahead = pose, behind = pose;
        (is_velocity ? ahead.v : ahead.q)[k] += k_step;
        (is_velocity ? behind.v : behind.q)[k] -= k_step;
        Vec9 difference = (probe.forces(ahead) - probe.forces(behind)) / (2.0 * k_step);
        Vec9 column = is_velocity ? by_v.col(k) : by_q.col(k);
        difference.head<3>().setZero(); // nor does anyone ask for the force on it
        column.head<3>().setZero();
        CHECK((difference - column).norm() < k_difference * (10.0 + column.norm()));
      }
  });
}

// Of forces by inner states, and of the rates of these by poses, velocities and themselves.
TEST_CASE("conformance: Jacobians of inner states against differences") {
  int count = 0;
  for_each_draw(false, [&](const ConformanceScene&, Probe& probe, const Pose& pose) {
    probe.forces(pose);
    std::vector<InnerJacobian> parts;
    for (const ForceGroup* group : probe.system().inner_groups) group->add_inner_jacobian(probe.evaluation(), parts);
    const auto differ = [&](const Pose& ahead, const Pose& behind, int inner, double step) { // of all forces, then of the rates of part j
      std::vector<double>& state = probe.state().inner;
      if (inner >= 0) state[inner] += step;
      const Vec9 more = probe.forces(ahead);
      const std::vector<double> faster = probe.inner_rates();
      if (inner >= 0) state[inner] -= 2.0 * step;
      const Vec9 less = probe.forces(behind);
      std::vector<double> rates = probe.inner_rates();
      if (inner >= 0) state[inner] += step;
      for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = (faster[i] - rates[i]) / (2.0 * step);
      return std::pair{Vec9((more - less) / (2.0 * step)), rates};
    };
    for (const InnerJacobian& j : parts) {
      const int body[2] = {j.a, j.b};
      for (int c = 0; c < j.count; ++c) {
        const auto [force, rates] = differ(pose, pose, j.first + c, k_step);
        for (int i = 0; i < 6; ++i)
          if (body[i / 3] != k_ground)
            CHECK(std::abs(force[3 * body[i / 3] + i % 3] - j.force(i, c)) < k_difference * (10.0 + j.force.norm()));
        for (int r = 0; r < j.count; ++r)
          CHECK(std::abs(rates[j.first + r] - j.by_inner(r, c)) < k_difference * (10.0 + j.by_inner.norm()));
      }
      for (int k = 0; k < 6; ++k)
        for (const bool is_velocity : {false, true}) {
          if (body[k / 3] == k_ground) continue;
          Pose ahead = pose, behind = pose;
          (is_velocity ? ahead.v : ahead.q)[3 * body[k / 3] + k % 3] += k_step;
          (is_velocity ? behind.v : behind.q)[3 * body[k / 3] + k % 3] -= k_step;
          const auto [force, rates] = differ(ahead, behind, -1, k_step);
          for (int r = 0; r < j.count; ++r) {
            const double by = is_velocity ? j.by_velocity(r, k) : j.by_pose(r, k);
            CHECK(std::abs(rates[j.first + r] - by) < k_difference * (10.0 + std::abs(by)));
          }
        }
      ++count;
    }
  });
  CHECK(count > 0);
}

TEST_CASE("conformance: watch values are continuous and their rates are their rates") {
  for_each_draw(false, [](const ConformanceScene&, Probe& probe, const Pose& pose) {
    probe.forces(pose);
    const std::vector<double> rate = probe.event_derivative();
    const double h = 1e-6;
    const auto at = [&](double t) {
      Pose p = pose;
      p.q += t * pose.v;
      probe.forces(p);
      return probe.event_value();
    };
    const std::vector<double> ahead = at(h), behind = at(-h), nearer = at(0.1 * h), now = at(0.0);
    for (std::size_t i = 0; i < now.size(); ++i) {
      if (std::abs(now[i]) > 1e200) continue; // no neighbour on this side of a table
      // Lipschitz: forces change by at most 1e4 N for each metre here.
      CHECK(std::abs(ahead[i] - now[i]) < 1e5 * h);
      CHECK(std::abs(nearer[i] - now[i]) < 1e4 * h);
      if (std::isfinite(rate[i])) CHECK(std::abs((ahead[i] - behind[i]) / (2.0 * h) - rate[i]) < 1e-5 * (1.0 + std::abs(rate[i])));
    }
  });
}
