// Errors follow the tolerance: the paper's transformer against the histories of an independent
// program, across all its events, over six decades of tolerance.
#include "tests/physics/paper_runs.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::testing;

namespace {

// The worst channel; y1 and y5 are left out, for the reference's twelve digits end at 1e-8 of their
// range.
double worst_error(const Run& r, const CsvTable& reference) {
  double worst = 0.0;
  for (const Common& common : common_channels()) {
    const std::string name = common.column;
    const std::vector<double>& column = reference.columns[reference.column(name, {})];
    const auto [least, most] = std::minmax_element(column.begin(), column.end());
    if (name == "y1" || name == "y5" || *least == *most) continue;
    worst = std::max(worst, relative_difference(r, reference, common));
  }
  return worst;
}

} // namespace

TEST_CASE("errors of the adaptive methods follow the tolerance over six decades, down to 1e-8 of range") {
  for (const Condition condition : {Condition::no_interference, Condition::interference})
    for (const char* integrator : {"tsit5", "dop853"}) {
      CAPTURE(name_of(condition));
      CAPTURE(integrator);
      const CsvTable reference = paper_reference(condition);
      double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, last = 1.0;
      for (int digits = 4; digits <= 10; ++digits) {
        last = worst_error(paper_run(condition, integrator, std::pow(10.0, -digits)), reference);
        const double x = -digits, y = std::log10(last);
        n += 1.0;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
      }
      const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
      CAPTURE(slope);
      // An error per step kept at the tolerance gives an error of the run in proportion to it,
      // times the number of steps, which grows as tolerance^(-1/5) or ^(-1/8): slopes of 0.8 to 1;
      // single runs scatter by a factor of three.
      CHECK(slope > 0.75);
      CHECK(slope < 1.25);
      CHECK(worst_error(paper_run(condition, integrator, 1e-12), reference) < 1e-8);
    }
}
