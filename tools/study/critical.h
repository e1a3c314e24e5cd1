// The kind "critical": the values of one variable at which an expression is zero.
#pragma once

#include "tools/study/study_kind.h"

namespace steplap::study {

struct CriticalSettings : KindSettings {
  std::string variable;
  std::string expression;  ///< whose zeros are looked for
  long points = 21;        ///< of the first look
  double tolerance = 1e-9; ///< of the variable's range
};

[[nodiscard]] StudyKind critical_kind();

} // namespace steplap::study
