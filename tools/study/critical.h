// Study kind "critical": finds the values of one variable at which an expression is zero.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

/// Settings of a "critical" study.
struct CriticalSettings : KindSettings {
  std::string variable;
  std::string expression;  ///< the expression whose zeros are searched
  long points = 21;        ///< number of points of the first scan
  double tolerance = 1e-9; ///< tolerance of a zero, relative to the variable's range
};

[[nodiscard]] StudyKind critical_kind();

} // namespace steplap::study
