// Friction of a face that is represented by a single contact point (polygon_contact). The point changes while the bodies rock within the
// contact penetration, and the new point may then have a small apparent velocity although the face sticks. This is an error of the
// approximation, not a motion, and must not start slip.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

/// Additional interface of a friction element with an approximate contact point.
class ApproximatePlace {
public:
  virtual ~ApproximatePlace() = default;
  /// Returns the speed, m/s, that contact point `to` may have although the face sticks at contact point `from`.
  [[nodiscard]] virtual double rate_error(const Evaluation& e, const FrictionState& from, const FrictionState& to) const = 0;
};

/// Returns ApproximatePlace::rate_error() of a friction element, m/s; 0 if its contact points are exact, as those of feet.
[[nodiscard]] inline double rate_error(const FrictionElement& friction, const Evaluation& e, const FrictionState& from,
                                       const FrictionState& to) {
  const auto* const approximate = dynamic_cast<const ApproximatePlace*>(&friction);
  return approximate ? approximate->rate_error(e, from, to) : 0.0;
}

} // namespace steplap
