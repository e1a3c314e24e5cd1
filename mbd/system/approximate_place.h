// Friction over a face that touches, held at one place which stands for all of it: polygon_contact. Which place that is changes
// as the bodies rock within the depth by which they press, and where the new place is not the old one, what held there
// moves here by what turning makes of that depth. This is an error of the place, not a motion: friction goes on holding.
#pragma once

#include "mbd/system/system.h"

namespace steplap {

class ApproximatePlace {
public:
  virtual ~ApproximatePlace() = default;
  /// The rate, m/s, at which the place `to` may move while the face holds as it did at the place `from`.
  [[nodiscard]] virtual double rate_error(const Evaluation& e, const FrictionState& from, const FrictionState& to) const = 0;
};

/// Zero of friction that acts at places of its own, such as feet.
[[nodiscard]] inline double rate_error(const FrictionElement& friction, const Evaluation& e, const FrictionState& from,
                                       const FrictionState& to) {
  const auto* const approximate = dynamic_cast<const ApproximatePlace*>(&friction);
  return approximate ? approximate->rate_error(e, from, to) : 0.0;
}

} // namespace steplap
