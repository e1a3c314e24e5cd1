// Study kind "map": finds the curve in the plane of two variables on which an expression is zero.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "map" study.
struct MapSettings : KindSettings {
  std::vector<std::string> variables; ///< names of the two variables
  std::string expression;             ///< expression whose zeros form the curve
  double step = 0.02;                 ///< step along the curve, relative to the ranges
  long points = 11;                   ///< number of points per side of the first grid
  double tolerance = 1e-9;
  bool is_logarithmic = false;
};

[[nodiscard]] StudyKind map_kind();

} // namespace steplap::study
