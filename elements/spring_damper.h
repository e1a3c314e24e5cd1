// Spring-damper between two markers, along an axis fixed in body b or from point to point.
//
// Elongation δ = measure − free length, force f = −k δ − c δ̇ on a along the measure's gradient (away
// from b when positive), its opposite on b. U = kδ²/2, it dissipates cδ̇². Optional dead band (gap) and
// tabulated characteristics, whose kinks are events. Source: physics.md §2, Eqs. (2), (4).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct SpringDamper : Element {
  std::string a, b = "ground";
  std::optional<Vec2> axis; ///< in marker b's axes; absent: point to point
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> free_length; ///< value of the measure without force
  std::optional<double> preload;     ///< f in the reference pose
  double gap = 0.0;                  ///< width of the dead band around the free length
  std::vector<Vec2> force_table;     ///< (δ, −f) instead of stiffness
  std::vector<Vec2> damping_table;   ///< (δ̇, −f) instead of damping
  std::string between = "lines";     ///< points of the tables: lines, whose corners are events, or a curve
  long count = 1;
};

/// The same for the relative angle of two bodies.
struct RotationalSpringDamper : Element {
  std::string a, b = "ground";
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> free_angle;
  std::optional<double> preload;
  double gap = 0.0;                ///< width of the dead band around the free angle, rad
  std::vector<Vec2> couple_table;  ///< (δ, −couple) instead of stiffness
  std::vector<Vec2> damping_table; ///< (δ̇, −couple) instead of damping
  std::string between = "lines";   ///< as of a SpringDamper
  long count = 1;
};

[[nodiscard]] const ElementKind& spring_damper_kind();
[[nodiscard]] const ElementKind& rotational_spring_damper_kind();

} // namespace steplap
