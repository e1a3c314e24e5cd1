// Gradients and second rates of rows: of every measure at random poses, by numbers that carry derivatives; and the short ways of
// frequent rows against the way of all.
#include "mbd/base/dual.h"
#include "mbd/dynamics/kinematics.h"
#include "mbd/dynamics/row_pull.h"
#include "mbd/system/law_group.h"
#include "tests/random/random_number.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <vector>

using namespace steplap;

namespace {

constexpr MeasureKind k_kinds[] = {MeasureKind::axis,       MeasureKind::distance, MeasureKind::angle, MeasureKind::roll_line,
                                   MeasureKind::roll_round, MeasureKind::slide,    MeasureKind::skate};
constexpr int k_poses = 200;

class Poses {
public:
  explicit Poses(std::uint64_t seed) : random_(seed) {}
  double number(double low, double high) { return random_.between(low, high); }

  Motion<double> body() {
    Motion<double> m;
    m.x = number(-2.0, 2.0);
    m.y = number(-2.0, 2.0);
    set_angle(m, number(-0.3, 0.3)); // so that a contact's axis never lies along its line
    m.vx = number(-1.0, 1.0);
    m.vy = number(-1.0, 1.0);
    m.omega = number(-3.0, 3.0);
    return m;
  }

  RowSpec row(MeasureKind kind) {
    RowSpec row;
    row.kind = kind;
    row.a = 1;
    row.b = 2;
    row.point_a = {number(-1.0, 1.0), number(-1.0, 1.0)};
    row.point_b = {number(14.0, 15.0), number(-1.0, 1.0)}; // far from a's: no distance is zero
    const double turn = number(-0.3, 0.3), shaft = number(-0.1, 0.1);
    row.direction = {-std::sin(turn), std::cos(turn)};
    row.contact_axis = {-std::sin(shaft), std::cos(shaft)};
    row.is_axis_in_a = true;
    row.radius_a = number(0.2, 1.0);
    row.radius_b = number(0.2, 1.0);
    return row;
  }

private:
  random::RandomNumber random_;
};

// A few dozen operations on numbers up to some 20 m, each rounded by 1e-16 of itself; a contact's 1/(n·s) is at most 3 here.
constexpr double k_rounding = 1e-12;

// What a row's coordinates change it by: of a skate, which has no value, its rate by theirs.
double gradient_at(MeasureKind kind, const MeasureValue<Dual<12>>& m, int k) {
  return kind == MeasureKind::skate ? m.rate.d[6 + k] : m.value.d[k];
}

bool is_near(double found, double wanted) { return std::abs(found - wanted) <= k_rounding * (1.0 + std::abs(wanted)); }

} // namespace

TEST_CASE("row gradient: what a measure changes by with the poses") {
  Poses poses(1);
  for (const MeasureKind kind : k_kinds)
    for (int i = 0; i < k_poses; ++i) {
      const RowSpec row = poses.row(kind);
      const Motion<double> a = poses.body(), b = poses.body();
      const RowGradient<double> g = row_gradient(row, a, b);
      const auto m = evaluate_row<false>(row, seeded(a, 0), seeded(b, 3));
      const double v[6] = {a.vx, a.vy, a.omega, b.vx, b.vy, b.omega};
      double rate = 0.0;
      for (int k = 0; k < 6; ++k) {
        CHECK(is_near(g.j[k], gradient_at(kind, m, k)));
        CHECK(is_near(g.j[k], m.rate.d[6 + k]));
        rate += gradient_at(kind, m, k) * v[k];
      }
      CHECK(is_near(evaluate_row<false>(row, a, b).rate, rate));
    }
}

TEST_CASE("row gradient: the second rate at zero accelerations is the rate's change along the velocity") {
  Poses poses(2);
  for (const MeasureKind kind : k_kinds)
    for (int i = 0; i < k_poses; ++i) {
      const RowSpec row = poses.row(kind);
      const Motion<double> a = poses.body(), b = poses.body();
      const auto rate = evaluate_row<false>(row, seeded(a, 0), seeded(b, 3)).rate;
      const double v[6] = {a.vx, a.vy, a.omega, b.vx, b.vy, b.omega};
      double second = 0.0;
      for (int k = 0; k < 6; ++k) second += rate.d[k] * v[k];
      CHECK(is_near(evaluate_row<true>(row, a, b).bias, second));
    }
}

namespace {

// Two clusters, which bodies 1 and 2 are or ride on.
Layout layout_of(bool is_alone, Poses& poses) {
  Layout layout;
  layout.clusters.resize(2);
  layout.placements.resize(3);
  for (int k = 0; k < 2; ++k) {
    layout.clusters[k].motion = is_alone ? k + 1 : 4 + k;
    layout.placements[k + 1].cluster = k;
    layout.placements[k + 1].is_alone = layout.placements[k + 1].is_trivial = is_alone;
    if (is_alone) continue;
    layout.placements[k + 1].offset = {poses.number(-1.0, 1.0), poses.number(-1.0, 1.0)};
    layout.placements[k + 1].angle = poses.number(-0.1, 0.1);
    layout.placements[k + 1].c = std::cos(layout.placements[k + 1].angle);
    layout.placements[k + 1].s = std::sin(layout.placements[k + 1].angle);
  }
  return layout;
}

constexpr int k_link = 3;

// Motions of the ground, bodies 1 and 2, the link between them, and two clusters.
std::vector<Motion<double>> motions(const Layout& layout, Poses& poses) {
  std::vector<Motion<double>> motion(6);
  for (int k = 0; k < 2; ++k) {
    Motion<double>& cluster = motion[layout.clusters[k].motion];
    cluster = poses.body();
    if (!layout.placements[k + 1].is_trivial) place_in_cluster(layout.placements[k + 1], cluster, motion[k + 1]);
  }
  motion[k_link] = seen_from(motion[1], motion[2]);
  return motion;
}

SchurRow row_between_clusters() {
  SchurRow row;
  row.is_constant = false;
  for (int side = 0; side < 2; ++side) {
    row.body[side] = side;
    for (int c = 0; c < 3; ++c) row.w[side][c] = 1.0 + side + c;
  }
  return row;
}

} // namespace

TEST_CASE("row gradient: in the coordinates of clusters, with or without riders") {
  Poses poses(3);
  for (const bool is_alone : {true, false})
    for (const MeasureKind kind : k_kinds) {
      if (kind == MeasureKind::angle) continue; // constant: the layout fills it in
      for (int i = 0; i < k_poses; ++i) {
        const Layout layout = layout_of(is_alone, poses);
        const auto motion = motions(layout, poses);
        const RowSpec spec = poses.row(kind);
        ActiveRow active;
        active.spec = &spec;
        active.link = k_link;
        active.is_simple = is_alone;
        SchurRow row = row_between_clusters();
        const MeasureValue<double> m = load_row<true>(layout, active, motion.data(), row);
        // By derivatives along the clusters' own coordinates.
        Motion<Dual<12>> member[2];
        double v[6];
        for (int k = 0; k < 2; ++k) {
          const Motion<double>& cluster = motion[layout.clusters[k].motion];
          member[k] = seeded(cluster, 3 * k);
          if (!is_alone) place_in_cluster(layout.placements[k + 1], seeded(cluster, 3 * k), member[k]);
          v[3 * k] = cluster.vx;
          v[3 * k + 1] = cluster.vy;
          v[3 * k + 2] = cluster.omega;
        }
        const auto truth = evaluate_row<false>(spec, member[0], member[1]);
        double second = 0.0;
        for (int k = 0; k < 6; ++k) {
          CHECK(is_near(row.j[k / 3][k % 3], gradient_at(kind, truth, k)));
          CHECK(row.wj[k / 3][k % 3] == row.w[k / 3][k % 3] * row.j[k / 3][k % 3]);
          second += truth.rate.d[k] * v[k];
        }
        CHECK(is_near(m.bias, second));
        CHECK(is_near(m.rate, truth.rate.v));
      }
    }
}

TEST_CASE("row gradient: the short ways along an axis and a slide") {
  Poses poses(4);
  const Layout layout = layout_of(true, poses);
  for (const MeasureKind kind : {MeasureKind::axis, MeasureKind::slide})
    for (int i = 0; i < k_poses; ++i) {
      const auto motion = motions(layout, poses);
      const RowSpec spec = poses.row(kind);
      ActiveRow active;
      active.spec = &spec;
      active.link = k_link;
      SchurRow by_all = row_between_clusters(), by_short = row_between_clusters();
      const double gamma = pull_row(layout, active, motion.data(), by_all);
      active.pull = kind == MeasureKind::axis ? RowPullKind::axis : RowPullKind::slide;
      CHECK(is_near(pull_row(layout, active, motion.data(), by_short), gamma));
      for (int k = 0; k < 6; ++k) CHECK(is_near(by_short.j[k / 3][k % 3], by_all.j[k / 3][k % 3]));
    }
}
