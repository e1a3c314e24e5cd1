// One kind of interface of a step-lap joint: a yoke sheet and a limb sheet pressed on each other.
//
// The yoke sheet's polygon is fixed in the active part, the limb sheet's in the limb; where they overlap
// at the present relative pose there is friction (Fig. 2 of the paper). A stack has `count` equal
// interfaces of the kind, each with the clamping pressure and the friction coefficients given, which do
// not change while the sheets slide. Several interfaces (corners, regions, packets of the stack) make up a joint.
// The pressure may vary linearly over the overlap, and with the acceleration across the sheets (transverse_pressure),
// which presses one side of a stack together and relieves the other; in time it varies as its joint says.
#pragma once

#include "elements/step_lap/patch/overlap.h"
#include "mbd/model/model.h"

namespace steplap {

struct StepLapInterface : Element {
  std::string joint;                                         ///< name of the step_lap_joint it belongs to
  std::vector<Vec2> yoke, limb;                              ///< m, either sense
  std::string frame = "ground";                              ///< "ground": reference pose; "body": each in its own body's frame
  std::vector<Vec2> yoke_holes, limb_holes;                  ///< centres of round holes, m, in the same frame
  std::vector<std::vector<Vec2>> yoke_cutouts, limb_cutouts; ///< rings of corners, m, either sense, same frame
  double hole_diameter = 0.0;                                ///< m
  long hole_sides = 24;                                      ///< a hole is a regular polygon of the circle's area
  double pressure = 0.0;                                     ///< Pa
  Vec2 pressure_gradient = Vec2::Zero();                     ///< Pa/m along x and y of the corners' frame
  double transverse_pressure = 0.0;                          ///< Pa per m/s² of the joint's transverse acceleration
  double transverse_spread = 0.0;                            ///< by which that of the outermost of its sheets differs, either way
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
  double count = 1.0;              ///< of equal interfaces
  std::string part;                ///< name of the packet of the limb's sheets that it holds; empty: none is told apart
  double part_share = 0.0;         ///< of the limb's weight that this packet has
  std::optional<double> clearance; ///< m, by which the limb may move towards the yoke before sheets butt
  std::optional<Vec2> across;      ///< direction from the yoke to the limb, as `frame`; none: between the sheets' middles
};

/// A round hole as it counts: a regular polygon of the circle's area.
[[nodiscard]] Ring round_hole(const Vec2& centre, double diameter, long sides);

/// The two sheets, each in its body's axes about its centre of gravity.
struct SheetPair {
  Outline yoke, limb;
  double static_traction = 0.0, kinetic_traction = 0.0; ///< count · μ · p, N/m²
  Vec2 gradient = Vec2::Zero();                         ///< of the traction, of itself, 1/m, active part's axes
  Vec2 middle = Vec2::Zero();                           ///< where it is `static_traction`: of the overlap in the reference pose
  double transverse = 0.0;                              ///< of itself, per m/s²
  double count = 1.0;
  std::optional<double> clearance; ///< m
  std::optional<Vec2> across;      ///< from the yoke to the limb, of length 1, in the active part's axes
};

/// Throws PolygonError for outlines that are none.
[[nodiscard]] SheetPair make_sheets(const StepLapInterface& interface, const std::string& limb, const std::string& active_part,
                                    const SystemBuilder& builder);

[[nodiscard]] const ElementKind& step_lap_interface_kind();

} // namespace steplap
