// What part a finding plays on the page, by the quantity it is of.
#pragma once

#include <string>

namespace steplap::study {

enum class UnitOf {
  none,
  subject, ///< of what the finding is about, which must be a column of the samples or a measured record
  quotient ///< of that by the variable's that the quantity names
};

struct FindingPart {
  std::string role;     ///< what the page does with it
  std::string quantity; ///< as it begins, followed by the name of a variable if this ends with a blank; as it ends, if this begins with one
  UnitOf unit = UnitOf::none;
  int digits = 6; ///< shown, where there is no interval
};

/// A finding whose quantity is a variable, and its value a coordinate of a point: the subject is the role and the point's number.
struct PointRole {
  std::string method; ///< of the finding
  std::string role;
};

} // namespace steplap::study
