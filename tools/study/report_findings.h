// Presentation of findings on a page: role, unit and digits of each.
#pragma once

#include "tools/study/finding.h"

#include <string>
#include <vector>

namespace steplap::study {

/// A column of samples.
struct ReportColumn {
  std::string name, unit, role; ///< role: variable, response, limit state, border, cost; history for a measured record
};

/// A finding prepared for the page.
struct FindingView {
  std::string role;            ///< probability, beta, first order, swing, …; "estimate" for an unknown quantity
  std::string variable;        ///< variable to which the quantity refers; "" if none
  long place = 0;              ///< number of a border or design point, from 1
  std::string value, interval; ///< formatted with the unit's prefix; "" if not available
  std::string unit;            ///< unit with its prefix; "SI" for an unknown quantity
};

/// Determines the presentation of a finding from its quantity.
[[nodiscard]] FindingView view_of(const Finding& finding, const std::vector<ReportColumn>& columns);

/// Formats an estimate so that the last digit is the second digit of the interval's width: "1.83e-4" for 1.8273e-4 with interval 1.5e-4 to
/// 2.2e-4. Without an interval, `digits` significant digits are shown.
[[nodiscard]] std::string estimate_text(double value, double low, double high, int digits);

} // namespace steplap::study
