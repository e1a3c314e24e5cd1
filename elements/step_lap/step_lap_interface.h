// One kind of interface of a step-lap joint: a yoke sheet and a limb sheet pressed together.
//
// The polygon of the yoke sheet is fixed in the active part, that of the limb sheet in the limb. Friction acts where they overlap at the
// present relative pose (Fig. 2 of the paper). A stack has `count` equal interfaces of this kind, each with the given clamping pressure and
// friction coefficients, which do not change during sliding. Several kinds (corners, regions, packets of the stack) make up a joint. The
// pressure may vary linearly over the overlap, and with the acceleration perpendicular to the sheets (transverse_pressure), which increases
// it on one side of a stack and decreases it on the other. Its variation in time is given by the joint.
#pragma once

#include "elements/step_lap/patch/overlap.h"
#include "mbd/model/model.h"

namespace steplap {

struct StepLapInterface : Element {
  std::string joint;                                         ///< name of its step_lap_joint
  std::vector<Vec2> yoke, limb;                              ///< outlines, m, in either order of corners
  std::string frame = "ground";                              ///< "ground": in the reference pose; "body": each in its own body's frame
  std::vector<Vec2> yoke_holes, limb_holes;                  ///< centres of round holes, m, same frame
  std::vector<std::vector<Vec2>> yoke_cutouts, limb_cutouts; ///< rings of corners, m, in either order, same frame
  double hole_diameter = 0.0;                                ///< diameter of the round holes, m
  long hole_sides = 24;                                      ///< number of sides of the regular polygon of equal area that models a hole
  double pressure = 0.0;                                     ///< clamping pressure, Pa
  Vec2 pressure_gradient = Vec2::Zero();                     ///< pressure gradient, Pa/m along x and y of the frame
  double transverse_pressure = 0.0;                          ///< pressure change, Pa per m/s² of the joint's transverse acceleration
  double transverse_spread = 0.0; ///< largest deviation (±) of transverse_pressure among the sheets of the interface, Pa per m/s²
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
  double count = 1.0;      ///< number of equal interfaces
  std::string part;        ///< name of the packet of limb sheets to which this interface belongs; empty: packets are not distinguished
  double part_share = 0.0; ///< fraction of the limb's weight in this packet
  std::optional<double> clearance; ///< distance by which the limb may move towards the yoke before sheets butt, m
  std::optional<Vec2> across;      ///< direction from yoke to limb, in `frame`; not given: between the centroids of the sheets
};

/// Returns the polygon of a round hole: regular, with the area of the circle.
[[nodiscard]] Ring round_hole(const Vec2& centre, double diameter, long sides);

/// The two sheets, each in its body's axes relative to its centre of gravity.
struct SheetPair {
  Outline yoke, limb;
  double static_traction = 0.0, kinetic_traction = 0.0; ///< tractions count · μ · p, N/m²
  Vec2 gradient = Vec2::Zero();                         ///< relative gradient of the traction, 1/m, axes of the active part
  Vec2 middle = Vec2::Zero(); ///< point at which the traction is `static_traction`: centroid of the overlap in the reference pose
  double transverse = 0.0;    ///< relative change of the traction per m/s² across the sheets
  double count = 1.0;
  std::optional<double> clearance; ///< clearance, m, as in StepLapInterface
  std::optional<Vec2> across;      ///< unit vector from yoke to limb, axes of the active part
};

/// Returns the sheets of an interface. Throws PolygonError for invalid outlines.
[[nodiscard]] SheetPair make_sheets(const StepLapInterface& interface, const std::string& limb, const std::string& active_part,
                                    const SystemBuilder& builder);

[[nodiscard]] const ElementKind& step_lap_interface_kind();

} // namespace steplap
