// Spring-damper between two markers, along an axis fixed in body b or from point to point.
//
// Elongation δ = measure − free length. The force f = −k δ − c δ̇ acts on a along the gradient of the measure (away from b if positive),
// its opposite on b. Stored energy U = kδ²/2, dissipated power cδ̇². Optional: a dead band (gap), tabulated characteristics, whose kinks are
// events, and ends that are apart out of the plane (space_distance.h). Source: theory.md §2, Eqs. (2), (4).
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct SpringDamper : Element {
  std::string a, b = "ground";
  std::optional<Vec2> axis; ///< direction of the spring in marker b's axes; not given: the line between the markers
  double across = 0.0;      ///< distance of the ends across the plane, m
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> carries, frequency, damping_ratio; ///< mass on all of them, kg; its frequency on them, Hz; ratio of its damping
  std::string material;                                    ///< of a pad (pad.h)
  std::optional<double> area, thickness;                   ///< of a pad, m², m
  std::optional<double> free_length;                       ///< value of the measure at zero force, m
  std::optional<double> preload;                           ///< force f in the reference pose, N
  double gap = 0.0;                                        ///< width of the dead band around the free length, m
  std::vector<Vec2> force_table;                           ///< points (δ, −f), replace stiffness
  std::vector<Vec2> damping_table;                         ///< points (δ̇, −f), replace damping
  std::string between = "lines";                           ///< interpolation of the tables: "lines", whose kinks are events, or "curve"
  long count = 1;
};

/// The corresponding spring and damper for the relative angle of two bodies.
struct RotationalSpringDamper : Element {
  std::string a, b = "ground";
  double stiffness = 0.0, damping = 0.0;
  std::optional<double> free_angle;
  std::optional<double> preload;
  double gap = 0.0;                ///< width of the dead band around the free angle, rad
  std::vector<Vec2> couple_table;  ///< points (δ, −moment), replace stiffness
  std::vector<Vec2> damping_table; ///< points (δ̇, −moment), replace damping
  std::string between = "lines";   ///< interpolation of the tables: "lines" or "curve"
  long count = 1;
};

/// Stiffness and damping of one of the elements side by side.
struct SpringConstants {
  double k = 0.0, c = 0.0; ///< N/m, N s/m
};
/// Returns them: as given, of a pad, or by the frequency f and damping ratio ζ of the mass m that all n elements carry, n k = m (2πf)² and
/// n c = 2ζ √(n k m).
[[nodiscard]] SpringConstants constants_of(const SpringDamper& spring);

[[nodiscard]] const ElementKind& spring_damper_kind();
[[nodiscard]] const ElementKind& rotational_spring_damper_kind();

} // namespace steplap
