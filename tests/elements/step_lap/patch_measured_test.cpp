// The law of the limit surface against measured pushes of a block on three feet (tests/data/experiments/three_feet.csv, which names the
// source). Each foot is a square so small that its extent does not matter. Feet test the principle, that the wrench of a sliding patch lies
// on the surface of the admissible wrenches, not the integral over an area.
//
// Friction of the whole block is as published, not fitted. A perfect law then gives a usage u = 1 for every push; a law with wrong friction
// gives another mean. The scatter about the mean measures the shape of the surface alone.
#include "elements/step_lap/patch/required_pressure.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

using namespace steplap;

namespace {

constexpr int k_sets = 8;
constexpr double k_side = 1e-4;                     // m, of a foot: its own moment is less than 0.3 % of its moment about the centre
constexpr double k_on_board = 4.2, k_on_wood = 5.0; // N, friction of the whole block as published

struct Mean {
  int count = 0;
  double sum = 0, squares = 0;

  void add(double x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double scatter() const { return std::sqrt(squares / count - mean() * mean()) / mean(); } ///< relative
};

struct Usages {
  Mean exact, ellipsoid;
};

// Returns the usage of the ellipsoid with the same largest force and moment about the centroid.
double ellipsoid_usage(const Capacity& c, const Vec3& w) {
  const double moment = w[2] - (c.arm.x() * w[1] - c.arm.y() * w[0]);
  return std::hypot(std::hypot(w[0], w[1]) / c.force, moment / c.couple);
}

Patch three_feet(const std::array<double, 16>& row, double friction) {
  Patch patch;
  for (std::size_t foot = 0; foot < 3; ++foot) {
    const double x = 1e-3 * row[1 + 2 * foot], y = 1e-3 * row[2 + 2 * foot], r = 0.5 * k_side;
    patch.add(Polygon{{{x - r, y - r}, {x + r, y - r}, {x + r, y + r}, {x - r, y + r}}, {}}, friction * row[7 + foot] / (k_side * k_side));
  }
  patch.prepare();
  return patch;
}

const std::array<Usages, k_sets>& usages() {
  static const std::array<Usages, k_sets> result = [] {
    std::array<Usages, k_sets> sets;
    std::ifstream file(std::string(STEPLAP_TEST_DATA) + "/experiments/three_feet.csv");
    std::string line;
    while (std::getline(file, line)) {
      if (line[0] < '1' || line[0] > '9') continue; // comments and names
      std::istringstream text(line);
      std::array<double, 16> row{};
      for (double& value : row) {
        std::string field;
        std::getline(text, field, ',');
        value = std::stod(field);
      }
      const Patch patch = three_feet(row, row[0] <= 4 ? k_on_board : k_on_wood);
      const Vec3 wrench(row[10], row[11], row[12]);
      const RequiredPressure found = required_pressure(patch, wrench);
      REQUIRE(found.converged);
      Usages& set = sets[static_cast<std::size_t>(row[0]) - 1];
      set.exact.add(found.u);
      set.ellipsoid.add(ellipsoid_usage(capacity(patch), wrench));
    }
    return sets;
  }();
  return result;
}

} // namespace

// Means lie within 15 % of 1, in set 3 within 28 %: the published friction has a scatter of its own, and which push needs more than 1 by how
// much is not explained. In set 3 the pushes themselves scatter by a quarter.
TEST_CASE("measured pushes of three feet use 1.08 to 1.14 of their limit surface, in one set 1.27") {
  for (std::size_t set = 0; set < k_sets; ++set) {
    CAPTURE(set + 1);
    const Mean& u = usages()[set].exact;
    MESSAGE("set ", set + 1, ": mean ", u.mean(), ", scatter ", u.scatter(), "; ellipsoid ", usages()[set].ellipsoid.mean(), ", ",
            usages()[set].ellipsoid.scatter());
    REQUIRE(u.count == 50);
    CHECK(std::abs(u.mean() - 1.0) < (set == 2 ? 0.28 : 0.15));
    CHECK(u.scatter() < (set == 2 ? 0.25 : 0.16));
  }
}

// The ellipsoid with the same force and moment is larger than the exact surface between its axes, so that its usages are smaller.
TEST_CASE("the exact surface describes the shape of measured wrenches better than an ellipsoid in six of eight sets") {
  int better = 0;
  for (const Usages& set : usages()) {
    CHECK(set.ellipsoid.mean() < set.exact.mean());
    CHECK(set.exact.scatter() < 1.05 * set.ellipsoid.scatter());
    better += set.exact.scatter() < 0.98 * set.ellipsoid.scatter();
  }
  CHECK(better == 6);
}
