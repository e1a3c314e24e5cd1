// The kind "map": the curve in the plane of two variables on which an expression is zero.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct MapSettings : KindSettings {
  std::vector<std::string> variables; ///< two
  std::string expression;             ///< the border is where it is zero
  double step = 0.02;                 ///< along the border, of the ranges
  long points = 11;                   ///< a side, of the first look
  double tolerance = 1e-9;
  bool is_logarithmic = false;
};

[[nodiscard]] StudyKind map_kind();

} // namespace steplap::study
