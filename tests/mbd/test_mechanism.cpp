// A mechanism in joint coordinates against dense algebra over its bodies: random trees of members with pins, a free member and rods,
// whose places, rates and accelerations follow from one chain of arms in truncated series of time.
#include "mbd/base/types.h"
#include "mbd/dynamics/mechanism.h"
#include "mbd/dynamics/schur.h"
#include "tests/random/random_number.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace steplap;
using random::RandomNumber;

namespace {

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

constexpr double k_rounding = std::numeric_limits<double>::epsilon();

// A number with its first and second derivative by time.
struct Series {
  double value = 0.0, rate = 0.0, second = 0.0;
  friend Series operator+(const Series& a, const Series& b) { return {a.value + b.value, a.rate + b.rate, a.second + b.second}; }
  friend Series operator*(double k, const Series& a) { return {k * a.value, k * a.rate, k * a.second}; }
};
Series sine(const Series& a) {
  const double s = std::sin(a.value), c = std::cos(a.value);
  return {s, c * a.rate, c * a.second - s * a.rate * a.rate};
}
Series cosine(const Series& a) {
  const double s = std::sin(a.value), c = std::cos(a.value);
  return {c, -s * a.rate, -s * a.second - c * a.rate * a.rate};
}

struct Drawn {
  Mechanism mechanism;
  int clusters = 0;
  Vec2 gravity{0.7, -9.0};
  std::vector<SchurRow> rows;
  std::vector<BodyForce> force; ///< per slot, which is a cluster's number and one
  VecX q, v;

  // x, y and θ of every cluster.
  [[nodiscard]] std::vector<Series> places(const std::vector<Series>& of) const {
    std::vector<Series> places(3 * static_cast<std::size_t>(clusters)), x(mechanism.members.size()), y(x);
    for (std::size_t i = 0; i < mechanism.members.size(); ++i) {
      const Member& m = mechanism.members[i];
      if (m.is_free) {
        x[i] = of[m.coordinate - 2];
        y[i] = of[m.coordinate - 1];
      } else if (m.parent < 0) {
        x[i].value = m.pin.x;
        y[i].value = m.pin.y;
      } else {
        const Series& above = of[mechanism.members[m.parent].coordinate];
        x[i] = x[m.parent] + m.pin.x * cosine(above) + -m.pin.y * sine(above);
        y[i] = y[m.parent] + m.pin.x * sine(above) + m.pin.y * cosine(above);
      }
      if (m.cluster < 0) continue;
      const Series& angle = of[m.coordinate];
      places[3 * m.cluster] = x[i] + m.centre.x * cosine(angle) + -m.centre.y * sine(angle);
      places[3 * m.cluster + 1] = y[i] + m.centre.x * sine(angle) + m.centre.y * cosine(angle);
      places[3 * m.cluster + 2] = angle;
    }
    return places;
  }
  [[nodiscard]] std::vector<Series> places(const VecX& rate, const VecX& second) const {
    std::vector<Series> of(static_cast<std::size_t>(q.size()));
    for (int k = 0; k < q.size(); ++k) of[k] = {q[k], rate[k], second[k]};
    return places(of);
  }
  // Rates of the clusters by those of the coordinates.
  [[nodiscard]] MatX rates() const {
    MatX t(3 * clusters, q.size());
    for (int k = 0; k < q.size(); ++k) {
      const std::vector<Series> moved = places(VecX::Unit(q.size(), k), VecX::Zero(q.size()));
      for (int i = 0; i < t.rows(); ++i) t(i, k) = moved[i].rate;
    }
    return t;
  }
  [[nodiscard]] VecX accelerations(const VecX& s) const {
    const std::vector<Series> moved = places(v, s);
    VecX a(3 * clusters);
    for (int i = 0; i < a.size(); ++i) a[i] = moved[i].second;
    return a;
  }
  [[nodiscard]] VecX masses() const {
    VecX m(3 * clusters);
    for (const Member& member : mechanism.members)
      if (member.cluster >= 0) m.segment<3>(3 * member.cluster) << member.mass, member.mass, member.inertia;
    return m;
  }
  // What acts on the clusters, weight and all.
  [[nodiscard]] VecX loads() const {
    VecX f(3 * clusters);
    for (const Member& member : mechanism.members)
      if (const BodyForce& at = force[member.cluster + 1]; member.cluster >= 0)
        f.segment<3>(3 * member.cluster) << at.fx + member.mass * gravity.x(), at.fy + member.mass * gravity.y(), at.m;
    return f;
  }
  [[nodiscard]] MatX gradients() const { // of the rows, by the clusters' coordinates
    MatX j = MatX::Zero(static_cast<Eigen::Index>(rows.size()), 3 * clusters);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (int side = 0; side < 2; ++side)
        for (int c = 0; c < 3 && rows[r].body[side] >= 0; ++c)
          j(static_cast<Eigen::Index>(r), 3 * rows[r].body[side] + c) += rows[r].j[side][c];
    return j;
  }
};

// A rod without mass in every fifth draw of a joint, and what hangs on its end.
void draw_members(RandomNumber& random, int count, Drawn& d) {
  std::vector<Member>& members = d.mechanism.members;
  const bool is_free = random.chance(0.3), is_chain = random.chance(0.4);
  while (static_cast<int>(members.size()) < count || members.back().cluster < 0) {
    Member m;
    const int before = static_cast<int>(members.size());
    if (before > 0) m.parent = is_chain || members.back().cluster < 0 ? before - 1 : random.below(before + 1) - 1;
    while (m.parent >= 0 && members[m.parent].cluster < 0 && m.parent < before - 1)
      m.parent = members[m.parent].parent; // a rod has one end
    m.is_free = before == 0 && is_free;
    const bool is_at_rod = m.parent >= 0 && members[m.parent].cluster < 0;
    m.pin = is_at_rod ? Pair<double>{random.between(0.2, 1.0), 0.0} : Pair<double>{random.either(0.1, 1.0), random.either(0.1, 1.0)};
    m.is_rod_end = is_at_rod;
    if (m.is_free || is_at_rod || !random.chance(0.2)) {
      m.cluster = d.clusters++;
      m.slot = m.cluster + 1;
      m.mass = random.decades(-0.5, 0.5);
      m.inertia = 0.1 * random.decades(-0.5, 0.5);
      if (!random.chance(0.2)) m.centre = {random.either(0.05, 0.5), random.either(0.05, 0.5)};
      if (m.is_free) m.centre = {}; // its place is that of its centre of gravity
    }
    members.push_back(m);
  }
}

SchurRow row_between(RandomNumber& random, const Drawn& d, int a, int b) {
  SchurRow row;
  row.body[0] = a;
  row.body[1] = b;
  const VecX m = d.masses();
  for (int side = 0; side < 2; ++side)
    for (int c = 0; c < 3 && row.body[side] >= 0; ++c) {
      row.w[side][c] = 1.0 / m[3 * row.body[side] + c];
      row.j[side][c] = random.either(0.2, 1.0);
      row.wj[side][c] = row.w[side][c] * row.j[side][c];
    }
  return row;
}

void pose(RandomNumber& random, Drawn& d) {
  const int n = d.mechanism.size();
  d.q = VecX(n);
  d.v = VecX(n);
  for (int k = 0; k < n; ++k) {
    d.q[k] = random.either(0.1, 3.0);
    d.v[k] = random.either(0.1, 2.0);
  }
  std::vector<Motion<double>> motion(static_cast<std::size_t>(d.clusters) + 1);
  d.mechanism.place(d.q.data(), d.v.data(), motion.data());
  const std::vector<Series> places = d.places(d.v, VecX::Zero(n));
  for (int k = 0; k < d.clusters; ++k) {
    const Motion<double>& now = motion[k + 1];
    const double found[6] = {now.x, now.y, now.theta, now.vx, now.vy, now.omega};
    for (int c = 0; c < 3; ++c) { // a sum of six arms of a metre or so, that turn at 2 rad/s
      CHECK(std::abs(found[c] - places[3 * k + c].value) < 20.0 * k_rounding);
      CHECK(std::abs(found[3 + c] - places[3 * k + c].rate) < 60.0 * k_rounding);
    }
  }
  d.force.assign(static_cast<std::size_t>(d.clusters) + 1, {});
  for (BodyForce& f : d.force) {
    f.fx = random.either(1.0, 20.0);
    f.fy = random.either(1.0, 20.0);
    f.m = random.either(1.0, 5.0);
  }
  d.mechanism.factor_mass();
}

// Closed for its bodies and for as many rows as `rows`, the second between the bodies of the first if they are `twins`; placed nowhere yet.
Drawn drawn(RandomNumber& random, int members, int rows, bool are_twins = false) {
  Drawn d;
  draw_members(random, members, d);
  for (int r = 0; r < rows; ++r) {
    const int a = random.below(d.clusters), b = random.below(d.clusters + 1) - 1;
    if (are_twins && r == 1) d.rows.push_back(row_between(random, d, d.rows[0].body[0], d.rows[0].body[1]));
    else d.rows.push_back(row_between(random, d, a, b == a ? -1 : b));
  }
  d.mechanism.row_count = rows;
  d.mechanism.close(d.clusters, d.gravity, d.rows.data());
  return d;
}

double condition_of(const MatX& a) {
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(a, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().tail(1)[0] / std::max(1e-300, eigen.eigenvalues()[0]);
}

VecX by_mechanism(const Mechanism& mechanism, VecX x) {
  mechanism.solve_mass(x.data());
  return x;
}

// Both are known to rounding, over which the mass matrix has its condition.
bool is_same(const VecX& found, const VecX& wanted, double condition) {
  return (found - wanted).norm() <= 20.0 * k_rounding * condition * std::max(wanted.norm(), 1e-3);
}

// (J M⁻¹ Jᵀ)⁻¹ r, M and J of `d`, by orthogonal factors of J L⁻ᵀ in 64 bits: the rows' condition counts once, not squared.
VecX multipliers_of(const Drawn& d, const VecX& right) {
  const LongMatrix t = d.rates().cast<long double>(), m = t.transpose() * d.masses().cast<long double>().asDiagonal() * t;
  const LongMatrix j = d.gradients().cast<long double>() * t;
  const LongMatrix white = m.llt().matrixL().solve(LongMatrix(j.transpose()));
  const Eigen::HouseholderQR<LongMatrix> qr(white);
  const LongMatrix upper = qr.matrixQR().topRows(j.rows()).template triangularView<Eigen::Upper>();
  const LongVector half = upper.transpose().template triangularView<Eigen::Lower>().solve(LongVector(right.cast<long double>()));
  return LongVector(upper.template triangularView<Eigen::Upper>().solve(half)).cast<double>();
}

} // namespace

TEST_CASE("mechanism: masses, accelerations and reactions against those of its bodies") {
  RandomNumber random(1);
  for (int draw = 0; draw < 400; ++draw) {
    CAPTURE(draw);
    Drawn d = drawn(random, 1 + draw % 6, draw % 3);
    const Mechanism& mechanism = d.mechanism;
    for (int look = 0; look < 2; ++look) { // a second pose, for what is kept from the first
      pose(random, d);
      const MatX t = d.rates(), m = t.transpose() * d.masses().asDiagonal() * t;
      const double condition = condition_of(m);
      const VecX x = VecX::Random(mechanism.size());
      CHECK(is_same(by_mechanism(mechanism, m * x), x, condition));

      VecX s(mechanism.size()), expanded(3 * d.clusters);
      mechanism.accelerate(d.force.data(), s.data());
      const VecX bias = d.accelerations(VecX::Zero(s.size()));
      const VecX pull = t.transpose() * (d.loads() - d.masses().asDiagonal() * bias);
      CHECK(is_same(s, m.ldlt().solve(pull), condition));
      mechanism.expand(s.data(), expanded.data());
      CHECK(is_same(expanded, d.accelerations(s), 10.0));

      // With rows that pull, every member keeps Newton's and Euler's laws with what its pins bear, a rod without mass too.
      d.mechanism.reduce_rows(d.rows.data());
      VecX lambda = 10.0 * VecX::Random(static_cast<Eigen::Index>(d.rows.size()));
      mechanism.add_response(lambda.data(), s.data());
      CHECK(is_same(s, m.ldlt().solve(VecX(pull + t.transpose() * (d.gradients().transpose() * lambda))), condition));
      const VecX a = d.accelerations(s), of_rows = d.gradients().transpose() * lambda, loads = d.loads();
      std::vector<Pair<double>> on_member;
      mechanism.pin_forces(a.data(), d.force.data(), d.rows.data(), lambda.data(), on_member);
      const double size = d.masses().cwiseProduct(a).norm() + loads.norm() + of_rows.norm();
      for (std::size_t i = 0; i < mechanism.members.size(); ++i) {
        const Member& member = mechanism.members[i];
        const Pair<double> lever = mechanism.lever(static_cast<int>(i));
        Vec3 lack = Vec3::Zero();
        if (member.cluster >= 0)
          for (int c = 0; c < 3; ++c) {
            const int k = 3 * member.cluster + c;
            lack[c] = loads[k] + of_rows[k] - d.masses()[k] * a[k];
          }
        lack += Vec3(on_member[i].x, on_member[i].y, -cross(lever, on_member[i]));
        for (std::size_t child = i + 1; child < mechanism.members.size(); ++child) {
          if (mechanism.members[child].parent != static_cast<int>(i)) continue;
          const Pair<double> from_centre = mechanism.arm(static_cast<int>(child)) - lever;
          lack -= Vec3(on_member[child].x, on_member[child].y, cross(from_centre, on_member[child]));
        }
        if (member.is_free) CHECK(Vec2(on_member[i].x, on_member[i].y).norm() < 100.0 * k_rounding * condition * size); // on nothing
        CHECK(lack.norm() < 100.0 * k_rounding * condition * size);
      }
    }
  }
}

TEST_CASE("mechanism: states are packed and unpacked, and nothing reaches farther than arms laid end to end") {
  RandomNumber random(2);
  for (int draw = 0; draw < 200; ++draw) {
    CAPTURE(draw);
    Drawn d = drawn(random, 1 + draw % 6, 0);
    pose(random, d);
    const Mechanism& mechanism = d.mechanism;
    const int n = mechanism.size();
    VecX places(3 * d.clusters), rates(3 * d.clusters), q(n), v(n);
    mechanism.unpack(d.q.data(), d.v.data(), places.data(), rates.data());
    const std::vector<Series> wanted = d.places(d.v, VecX::Zero(n));
    for (int i = 0; i < 3 * d.clusters; ++i) {
      CHECK(std::abs(places[i] - wanted[i].value) < 20.0 * k_rounding);
      CHECK(std::abs(rates[i] - wanted[i].rate) < 60.0 * k_rounding);
    }
    mechanism.pack(places.data(), rates.data(), q.data(), v.data());
    CHECK((q - d.q).norm() < 1e-13); // rods of 0.2 m: the rounding of places over their length
    CHECK((v - d.v).norm() < 1e-12);
    CHECK(mechanism.is_at(d.q.data(), d.v.data()));

    std::vector<double> farthest(mechanism.members.size(), 0.0);
    for (const Member& last : mechanism.members) { // up from each: what lies between its centre and the pins above
      double path = std::hypot(last.centre.x, last.centre.y);
      for (const Member* at = &last;; at = &mechanism.members[at->parent]) {
        double& reach = farthest[static_cast<std::size_t>(at - mechanism.members.data())];
        reach = std::max(reach, path);
        if (at->parent < 0) break;
        path += std::hypot(at->pin.x, at->pin.y);
      }
    }
    for (std::size_t i = 0; i < mechanism.members.size(); ++i)
      CHECK(std::abs(mechanism.reach(mechanism.members[i].coordinate) - farthest[i]) < 20.0 * k_rounding);
  }
}

// Damped too: a fraction of what a row would have if its bodies were free is added to the diagonal.
TEST_CASE("mechanism: rows against a dense factorisation") {
  RandomNumber random(3);
  int compared = 0;
  for (int draw = 0; draw < 600; ++draw) {
    CAPTURE(draw);
    const int rows = 1 + draw % 7;
    Drawn d = drawn(random, 2 + draw % 6, rows);
    Mechanism& mechanism = d.mechanism;
    pose(random, d);
    const MatX t = d.rates(), m = t.transpose() * d.masses().asDiagonal() * t, j = d.gradients() * t;
    mechanism.reduce_rows(d.rows.data());
    const VecX change = VecX::Random(mechanism.size());
    for (int r = 0; r < rows; ++r) CHECK(std::abs(mechanism.along(r, change.data()) - j.row(r).dot(change)) < 100.0 * k_rounding);
    for (const double shift : {0.0, 1e-3, 0.2}) {
      CAPTURE(shift);
      MatX a = j * m.ldlt().solve(MatX(j.transpose()));
      const MatX of_bodies = d.gradients() * d.masses().cwiseInverse().asDiagonal() * d.gradients().transpose();
      a.diagonal() += shift * of_bodies.diagonal();
      const double condition = condition_of(a);
      if (condition > 1e6) continue; // more rows than coordinates, undamped: asked below
      mechanism.factor_rows(d.rows.data(), shift);
      CHECK(!mechanism.is_singular());
      const VecX wanted = VecX::Random(rows);
      VecX x = a * wanted;
      mechanism.solve_rows(x.data());
      CHECK(is_same(x, wanted, 5.0 * condition * condition_of(m))); // A itself is known to the condition of M
      ++compared;
    }
  }
  CHECK(compared > 800);
}

// A second row that differs from the first by δ: its pivot is δ², and elimination alone loses the digits of δ².
TEST_CASE("mechanism: rows that are nearly the same keep the digits that their difference has") {
  RandomNumber random(4);
  int compared = 0;
  for (int draw = 0; draw < 300; ++draw) {
    const double delta = random.decades(-5.5, -3.0);
    const int rows = 2 + draw % 3;
    Drawn d = drawn(random, 4 + draw % 3, rows, true);
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) {
        SchurRow& other = d.rows[1];
        other.j[side][c] = d.rows[0].j[side][c] + delta * other.j[side][c];
        other.wj[side][c] = other.w[side][c] * other.j[side][c];
      }
    pose(random, d);
    const MatX t = d.rates(), m = t.transpose() * d.masses().asDiagonal() * t;
    const MatX j = d.gradients() * t, a = j * m.ldlt().solve(MatX(j.transpose()));
    const double rows_condition = std::sqrt(condition_of(a)); // of J L⁻ᵀ
    if (!(rows_condition < 1e6)) continue;                    // the row has moved nothing, or hardly
    CAPTURE(draw);
    CAPTURE(delta);
    d.mechanism.reduce_rows(d.rows.data());
    d.mechanism.factor_rows(d.rows.data(), 0.0);
    if (d.mechanism.is_singular() || d.mechanism.smallest_pivot() >= SchurSolver::k_refined_pivot) continue;
    const VecX right = VecX::Random(rows), wanted = multipliers_of(d, right);
    VecX x = right;
    d.mechanism.solve_rows(x.data());
    CHECK((x - wanted).norm() < 200.0 * k_rounding * condition_of(m) * rows_condition * wanted.norm());
    ++compared;
  }
  CHECK(compared > 100);
}

TEST_CASE("mechanism: a row of friction that moves nothing stays out, one of a joint is dependent but not left out") {
  RandomNumber random(5);
  Drawn d = drawn(random, 3, 3);
  for (int r = 1; r < 3; ++r)
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) d.rows[r].j[side][c] = d.rows[r].wj[side][c] = 0.0;
  pose(random, d);
  d.mechanism.reduce_rows(d.rows.data());
  const std::vector<char> is_friction = {1, 1, 0}, was_out = {0, 0, 0};
  d.mechanism.decide_rank(is_friction.data(), was_out.data());
  CHECK(d.mechanism.is_rank_open());
  d.mechanism.factor_rows(d.rows.data(), 0.0);
  CHECK(!d.mechanism.is_rank_open());
  for (int r = 0; r < 3; ++r) {
    CHECK(d.mechanism.is_dependent(r) == (r > 0));
    CHECK(d.mechanism.is_left_out(r) == (r == 1));
  }
}

TEST_CASE("mechanism: friction stays out for joints, not joints for friction") {
  RandomNumber random(6);
  for (int draw = 0; draw < 40; ++draw) {
    CAPTURE(draw);
    Drawn d = drawn(random, 3 + draw % 4, 2, true);
    const double factor = draw % 2 == 0 ? 1.0 : -0.7;
    for (int side = 0; side < 2; ++side)
      for (int c = 0; c < 3; ++c) {
        d.rows[1].j[side][c] = factor * d.rows[0].j[side][c];
        d.rows[1].wj[side][c] = factor * d.rows[0].wj[side][c];
      }
    pose(random, d);
    d.mechanism.reduce_rows(d.rows.data());
    const char friction = draw % 3 == 0 ? 0 : 1;
    const std::vector<char> is_friction = {friction == 0, friction == 1}, was_out = {0, 0};
    d.mechanism.decide_rank(is_friction.data(), was_out.data());
    d.mechanism.factor_rows(d.rows.data(), 0.0);
    for (int r = 0; r < 2; ++r) {
      CHECK(d.mechanism.is_left_out(r) == (r == friction));
      CHECK(d.mechanism.is_dependent(r) == (r == friction));
    }
  }
}
