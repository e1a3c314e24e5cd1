// Bands and belts with friction e^{μα} (sliding_band.h): a rope around a bollard, a band brake, a belt between two wheels.
//
// A band runs from marker a to a drum, around it, and on to marker b. The wrap angle α follows from the directions of its free parts, plus
// the given number of whole turns. A belt runs around two wheels; its two free parts are common tangents, and it slides on the wheel with
// the smaller μ α. Free parts are elastic, wrapped parts are not: the creep of an elastic belt, which slows the driven wheel by some tenths
// of a percent, is neglected, and so is the centrifugal tension of a fast belt.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Band : Element {
  std::string a, b = "ground", drum = "ground"; ///< markers of the ends; marker at the centre of the drum
  double radius = 0.0;                          ///< radius of the drum, m; negative if the band runs clockwise around it from a to b
  long turns = 0;                               ///< whole turns in addition to the angle between the free parts
  double friction = 0.0;                        ///< coefficient of friction μ
  double stiffness = 0.0;                       ///< stiffness of the part at a, N/m
  std::optional<double> stiffness_b;            ///< stiffness of the part at b, N/m; default: as at a
  double damping = 0.0;                    ///< damping of the part at a, N s/m; that of the part at b has the same ratio to the stiffness
  std::optional<double> pretension, slack; ///< tension, N, or slack, m, in the reference pose
  std::string source;                      ///< origin of the friction coefficient, quoted in results where it is unusual
};

struct Belt : Element {
  std::string a, b = "ground";           ///< markers at the centres of the wheels
  double radius_a = 0.0, radius_b = 0.0; ///< radii of the wheels, m
  bool crossed = false;
  double friction_a = 0.0, friction_b = 0.0; ///< coefficients of friction μ
  double stiffness = 0.0, damping = 0.0;     ///< stiffness, N/m, and damping, N s/m, of each free part
  std::optional<double> pretension, slack;   ///< tension, N, or slack, m, in the reference pose
  std::string source;                        ///< origin of the friction coefficients, quoted in results where they are unusual
};

[[nodiscard]] const ElementKind& band_kind();
[[nodiscard]] const ElementKind& belt_kind();

} // namespace steplap
