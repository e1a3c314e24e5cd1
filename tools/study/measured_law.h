// Fits a distribution to measured values of a variable and tests the fit.
#pragma once

#include "tools/study/study.h"

#include <openturns/Distribution.hxx>

namespace steplap::study {

/// A fitted distribution.
struct MeasuredLaw {
  OT::Distribution distribution; ///< truncated if the variable has bounds
  std::string text;              ///< ", fitted to 400 values (Kolmogorov's p 0.3)"
  bool is_misfit = false;        ///< true if the test rejects the distribution at the 1 % level
};

/// Fits the distribution to the values in the file `measured`. If all values lie within the variable's bounds, these are assumed to have
/// applied to the measured quantity, and the truncated distribution is fitted by maximum likelihood (a lognormal or Weibull distribution
/// then begins at zero). If values lie outside, the distribution is fitted to all of them and truncated afterwards. Throws ModelError.
[[nodiscard]] MeasuredLaw measured_law(const Variable& variable);

/// Returns the distribution truncated at the variable's bounds.
[[nodiscard]] OT::Distribution truncated(const Variable& variable, const OT::Distribution& distribution);

} // namespace steplap::study
