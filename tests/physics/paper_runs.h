// The paper's transformer in both conditions, and the reference histories that an independent program
// computed in minimal coordinates.
#pragma once

#include "mbd/io/csv.h"
#include "tests/physics/scene.h"

namespace steplap::testing {

enum class Condition { no_interference, interference };

inline const char* name_of(Condition condition) { return condition == Condition::interference ? "interference" : "no_interference"; }

inline Model paper_model(Condition condition) {
  return read_model(std::string(STEPLAP_MODELS) + "/paper/" + name_of(condition) + ".toml", transformer_catalog());
}

inline CsvTable paper_reference(Condition condition) {
  return read_csv(std::string(STEPLAP_TEST_DATA) + "/reference/" + name_of(condition) + ".csv", {});
}

inline Run paper_run(Condition condition, const std::string& integrator, double step_or_tolerance) {
  return run(paper_model(condition), {integrator, step_or_tolerance, 0.8, 1e-3});
}

/// Column of the reference, channel here, factor between the two.
struct Common {
  const char* column;
  const char* channel;
};

inline const std::vector<Common>& common_channels() {
  static const std::vector<Common> list = {{"x1", "active part.x"},
                                           {"y1", "active part.y"},
                                           {"theta1", "active part.theta"},
                                           {"y5", "lower tank.y"},
                                           {"theta5", "lower tank.theta"},
                                           {"s4", "tank flexibility.elongation"},
                                           {"friction", "tank bottom.friction"},
                                           {"normal", "tank bottom.normal"},
                                           {"foot_front", "front foot.force"},
                                           {"foot_rear", "rear foot.force"},
                                           {"wood_front", "front block.force"},
                                           {"wood_rear", "rear block.force"},
                                           {"top_arrest", "top arresting.force"},
                                           {"bottom_arrest", "bottom arresting.force"},
                                           {"tank", "tank flexibility.force"},
                                           {"slide", "tank bottom.slide"},
                                           {"fx2", "front joint.fx"},
                                           {"fy2", "front joint.fy"},
                                           {"m2", "front joint.m"},
                                           {"fx3", "back joint.fx"},
                                           {"fy3", "back joint.fy"},
                                           {"m3", "back joint.m"}};
  return list;
}

/// Largest difference of one channel from a column of the reference, divided by the column's range.
inline double relative_difference(const Run& r, const CsvTable& reference, const Common& common) {
  const std::vector<double>& expected = reference.columns[reference.column(common.column, {})];
  const std::vector<double> computed = r.series(common.channel); // has a sample at t = 0 besides
  double least = expected[0], most = expected[0], worst = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    least = std::min(least, expected[i]);
    most = std::max(most, expected[i]);
    worst = std::max(worst, std::abs(expected[i] - computed.at(i + 1)));
  }
  return worst / (most - least);
}

} // namespace steplap::testing
