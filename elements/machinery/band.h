// Bands and belts with friction e^{μα} (sliding_band.h): a rope round a bollard, a band brake, a belt between two wheels.
//
// A band runs from marker a to a drum, round it, and on to marker b. The angle α at which it lies on the drum follows the directions of its
// free parts; whole turns besides are told. A belt runs round two wheels; its two free parts are straight tangents of both, and it slides on
// the wheel where μ α is smaller. The parts stretch, what lies on a drum or wheel does not: the creep of an elastic belt, which turns a
// driven wheel slower by some per mille, is left out, and so is the pull of a fast belt's own mass.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Band : Element {
  std::string a, b = "ground", drum = "ground"; ///< ends; centre of the drum
  double radius = 0.0;                          ///< m, of the drum; negative where it goes round it clockwise on the way from a to b
  long turns = 0;                               ///< whole ones, besides the angle that the drawing shows
  double friction = 0.0;                        ///< μ
  double stiffness = 0.0;                       ///< N/m, of the part at a
  std::optional<double> stiffness_b;            ///< N/m; default: as at a
  double damping = 0.0;                         ///< N s/m, of the part at a; at b in proportion to the stiffness
  std::optional<double> pretension, slack;      ///< N, m, in the reference pose
  std::string source;                           ///< origin of the friction; results name it where that is unusual
};

struct Belt : Element {
  std::string a, b = "ground";           ///< centres of the wheels
  double radius_a = 0.0, radius_b = 0.0; ///< m
  bool crossed = false;
  double friction_a = 0.0, friction_b = 0.0; ///< μ
  double stiffness = 0.0, damping = 0.0;     ///< N/m, N s/m, of each free part
  std::optional<double> pretension, slack;   ///< N, m, in the reference pose
  std::string source;                        ///< origin of the friction; results name it where that is unusual
};

[[nodiscard]] const ElementKind& band_kind();
[[nodiscard]] const ElementKind& belt_kind();

} // namespace steplap
