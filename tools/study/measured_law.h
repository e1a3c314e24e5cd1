// The distribution of a variable that was measured: fitted to the values, and held against them.
#pragma once

#include "tools/study/study.h"

#include <openturns/Distribution.hxx>

namespace steplap::study {

struct MeasuredLaw {
  OT::Distribution distribution; ///< truncated where the variable is
  std::string text;              ///< ", fitted to 400 values (Kolmogorov's p 0.3)"
  bool is_misfit = false;        ///< such values would come from it in less than one case of a hundred
};

/// Of the values in the file `measured`. Bounds within which all values lie belong to what was measured: the whole is
/// found from what is left of it (maximum likelihood; a lognormal or Weibull distribution then begins at zero). Where
/// values lie outside, the bounds cut off what was fitted to all of them. Throws ModelError.
[[nodiscard]] MeasuredLaw measured_law(const Variable& variable);

/// Cut off at the variable's bounds.
[[nodiscard]] OT::Distribution truncated(const Variable& variable, const OT::Distribution& distribution);

} // namespace steplap::study
