// The limit surface against 50-digit values (tools/make_patch_reference.py) and across its switch.
#include "patch_cases.h"

#include <doctest/doctest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>

using namespace steplap;
using namespace steplap::patch_cases;

namespace {

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

Ring read_ring(const std::string& text) {
  Ring ring;
  for (const std::string& vertex : split(text, ';')) {
    const auto xy = split(vertex, ' ');
    ring.emplace_back(std::stod(xy.at(0)), std::stod(xy.at(1)));
  }
  return ring;
}

struct Row {
  std::string name, where;
  Polygon polygon;
  Traction traction;
  Vec2 point;
  Vec3 nu, gradient;
  double h;
};

std::vector<Row> read_table() {
  std::ifstream file(STEPLAP_TEST_DATA "/patch_reference.csv");
  std::vector<Row> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    const auto cell = split(line, ',');
    const auto number = [&](std::size_t i) { return std::stod(cell.at(i)); };
    Row row{cell.at(0),
            cell.at(1),
            {},
            {number(3), {number(4), number(5)}},
            {number(6), number(7)},
            {number(8), number(9), number(10)},
            {number(12), number(13), number(14)},
            number(11)};
    for (const std::string& ring : split(cell.at(2), '|'))
      (row.polygon.outer.empty() ? row.polygon.outer : row.polygon.holes.emplace_back()) = read_ring(ring);
    rows.push_back(row);
  }
  return rows;
}

double largest_traction(const Row& row) {
  double w = 0;
  for (const Vec2& p : row.polygon.outer) w = std::max(w, row.traction.at_centroid + row.traction.gradient.dot(p - row.point));
  return w;
}

} // namespace

TEST_CASE("patch: h and the wrench agree with 50-digit values") {
  // 1e-12 of traction × area × (speed, one, size): the closed forms lose about |c|²/area·1e-16 up
  // to the switch at 6 radii, 5e-13 for the table's worst shape, a band 70 times longer than wide.
  constexpr double tolerance = 1e-12;
  const auto rows = read_table();
  REQUIRE(rows.size() > 400);
  std::map<std::string, double> worst;
  for (const Row& row : rows) {
    for (const bool prepared : {false, true}) {
      Patch patch(row.point);
      patch.add(row.polygon, row.traction);
      if (prepared) patch.prepare();
      const Dissipation d = evaluate(patch, row.nu);
      const double size = patch.pieces().front().radius;
      const double force = largest_traction(row) * patch.area();
      const double speed = std::max(row.nu.head<2>().norm(), size * std::abs(row.nu[2]));
      const Vec3 error = d.gradient - row.gradient;
      const double e =
          std::max({std::abs(d.h - row.h) / (force * speed), error.head<2>().norm() / force, std::abs(error[2]) / (force * size)});
      CAPTURE(row.name);
      CAPTURE(row.where);
      CAPTURE(row.nu.transpose());
      CHECK(e < tolerance);
      worst[row.name + " " + row.where] = std::max(worst[row.name + " " + row.where], e);
      // without the Hessian it is the same arithmetic
      CHECK(evaluate_gradient(patch, row.nu).gradient == d.gradient);
    }
  }
  double all = 0;
  for (const auto& [what, e] : worst) all = std::max(all, e);
  MESSAGE("largest error: " << all);
}

TEST_CASE("patch: nothing shows where closed form and expansion meet") {
  // Just inside and just outside k_far_ratio radii the two must agree to what either is good for.
  Draw draw(11);
  for (int i = 0; i < cases(20000); ++i) {
    const Polygon polygon = draw.coin() ? convex_polygon(draw) : concave_polygon(draw);
    Patch patch(centroid(polygon));
    patch.add(polygon, 1.0);
    patch.prepare();
    const double size = patch.pieces()[0].radius, angle = draw.within(0, 6.3);
    const double omega = draw.sign();
    const auto at = [&](double ratio) {
      const double v = ratio * k_far_ratio * size;
      return evaluate(patch, {v * std::cos(angle), v * std::sin(angle), omega});
    };
    // The closed form sums terms of size |c|²·size to areas: rounding 1e-16 · 36 · size² times a
    // few per edge, whatever the area. The twist's own change of 2e-13 moves h by that share of
    // the force, and the wrench by less.
    const Dissipation in = at(1 - 1e-13), out = at(1 + 1e-13);
    const double force = patch.force(), speed = k_far_ratio * size;
    const double rounding = 1e-16 * 36 * 20 * size * size;
    CHECK(std::abs(in.h - out.h) < 2e-13 * force * speed + rounding * size);
    CHECK((in.gradient - out.gradient).head<2>().norm() < 2e-13 * force + rounding);
    CHECK(std::abs(in.gradient[2] - out.gradient[2]) < 2e-13 * force * size + rounding * size);
    // Second derivatives: the same terms, and for ω two more factors of |c| by homogeneity; the
    // expansion leaves out n²·6⁻¹⁹·… = 1e-14.
    const Mat3 change = in.hessian - out.hessian;
    CHECK(change.topLeftCorner<2, 2>().norm() < (1e-12 * force + rounding) / speed);
    CHECK(std::abs(change(2, 2)) < 36 * size * size * (1e-12 * force + rounding) / speed);
  }
}

TEST_CASE("patch: the derivatives are those of h") {
  // Central differences in the step that balances truncation and rounding: eps^(1/3) = 6e-6 of the
  // twist, error about its square times the third derivative, which near a centre inside a thin
  // piece is some hundreds.
  Draw draw(12);
  for (int i = 0; i < cases(2000); ++i) {
    const Patch patch = patch_cases::patch(draw);
    Vec3 nu = draw.twist();
    nu /= fastest(patch, nu);
    const Dissipation d = evaluate(patch, nu);
    const double step = 6e-6;
    const Vec3 scale(1, 1, 1 / reach(patch));
    for (int k = 0; k < 3; ++k) {
      Vec3 offset = Vec3::Zero();
      offset[k] = step * scale[k];
      const Dissipation up = evaluate(patch, nu + offset), down = evaluate(patch, nu - offset);
      const double slope = (up.h - down.h) / (2 * step);
      CHECK(std::abs(slope - d.gradient[k] * scale[k]) < 1e-7 * patch.force());
      const Vec3 bend = (up.gradient - down.gradient) / (2 * step);
      const Vec3 column = d.hessian.col(k) * scale[k];
      const double curvature = scale.cwiseProduct(d.hessian.diagonal()).cwiseProduct(scale).norm();
      CHECK((bend - column).cwiseProduct(scale).norm() < 2e-4 * (curvature + patch.force()));
    }
  }
}
