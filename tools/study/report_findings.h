// Findings as a page shows them: what part each plays, its unit, its digits.
#pragma once

#include "tools/study/finding.h"

#include <string>
#include <vector>

namespace steplap::study {

/// A column of samples.
struct ReportColumn {
  std::string name, unit, role; ///< role: variable, response, limit state, border, cost; history for a measured record
};

struct FindingView {
  std::string role;            ///< probability, beta, first order, swing, …; "estimate": nothing is known of the quantity
  std::string variable;        ///< that the quantity is about, "" if about none
  long place = 0;              ///< of a border or a design point, from 1
  std::string value, interval; ///< as text, with the unit's prefix; "" for none
  std::string unit;            ///< with its prefix; "SI" where nothing is known of the quantity
};

/// The quantity of a finding is what says which part it plays.
[[nodiscard]] FindingView view_of(const Finding& finding, const std::vector<ReportColumn>& columns);

/// "1.83e-4" for 1.8273e-4 with an interval of 1.5e-4 to 2.2e-4: two digits of the interval's width are written, of
/// which the first is known to mean something. Without an interval `digits`.
[[nodiscard]] std::string estimate_text(double value, double low, double high, int digits);

} // namespace steplap::study
