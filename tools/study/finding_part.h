// Describes how a page presents a finding, depending on its quantity.
#pragma once

#include "tools/study/finding.h"

#include <string>

namespace steplap::study {

/// Source of a finding's unit.
enum class UnitOf {
  none,
  subject, ///< unit of the finding's subject, which must be a column of the samples or a measured record
  quotient ///< that unit divided by the unit of the variable named in the quantity
};

/// How the page presents findings whose quantity has the text `quantity`.
struct FindingPart {
  std::string role;     ///< role of the finding on the page: probability, beta, border, …
  std::string quantity; ///< text of the quantity: a prefix followed by a variable's name if it ends with a blank; a suffix if it begins
                        ///< with a blank
  UnitOf unit = UnitOf::none;
  int digits = 6; ///< digits shown if there is no interval
};

/// A finding that is a coordinate of a point: the quantity is a variable, the subject consists of the role and the number of the point.
struct PointRole {
  std::string method; ///< method of the finding
  std::string role;
  bool is_for_page = false; ///< true if the points are many: only the page shows them

  /// Returns true if the finding is a coordinate of such a point.
  [[nodiscard]] bool has(const Finding& finding) const { return finding.method == method && finding.subject.starts_with(role + " "); }
};

} // namespace steplap::study
