// [[core]]: the step-lap joints between the limbs of a core and its yokes, from the core's dimensions.
//
// For each limb named there is one step_lap_joint, and at each of its corners one step_lap_interface for each
// kind of pair of neighbouring layers whose sheets overlap there (stack.h), with the outlines of these sheets
// (corner.h) in ground coordinates of the reference pose, and their number. The origin of a limb's body frame
// is the middle of the limb: on its axis, at half the core's height. Its centre of gravity, and its mass and
// inertia unless they are given, are those of its sheets.
// An outer limb has one mitre at either end, a middle limb ends in a point between two (T-joint).
// Assumes rectangular packets, and pressure uniform over a corner or linear. What is assumed, and its source: docs/reference/core.md.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Core : TableObject {
  std::string active_part;               ///< body with the yokes
  std::vector<std::string> limbs;        ///< bodies of the outer limbs
  std::vector<std::string> middle_limbs; ///< bodies of the limbs between
  std::vector<std::string> joints;       ///< one for each limb, outer ones first; default "<limb> joint"

  double core_height = 0.0;                                   ///< m, of the packet with the highest yokes
  std::optional<double> limb_width, yoke_height, stack_depth; ///< m, of a core of one packet
  std::vector<Vec2> packets;                                  ///< width of the limb's sheets and depth of each, front to back, m
  std::vector<double> yoke_heights;                           ///< of each packet, m
  std::vector<double> pressure_shares;                        ///< of each packet, of `pressure`; none: all 1
  std::string yoke_steps = "both";                            ///< where yokes of several packets are stepped: "both", "window", "outside"
  std::vector<Vec2> ducts;                                    ///< place in the stack, width, m
  std::vector<Vec2> bolt_holes;             ///< from where the axes of limb and yoke cross: outwards, away from the window, m
  std::optional<double> bolt_hole_diameter; ///< m
  std::optional<double> mitre_angle;        ///< rad against the yoke; default: from corner to corner
  std::optional<double> notch_angle;        ///< rad, of either side of a T-joint's point against the yoke; default 45°

  // Overlaps: either counted and measured, …
  std::optional<double> overlap, interfaces; ///< m; number a corner
  std::string sheet_outlines = "real";       ///< "real" or "strips": square ends, as in the paper
  std::optional<double> tongue, margin;      ///< m, of strips: sheet on either side of the middle of the mitre; of the
                                             ///< yoke sheet beyond the limb's at both ends of it
  // … or as the stack is built.
  std::optional<double> sheet_thickness, stacking_factor, step_pitch, clearance; ///< m, 1, m, m
  std::optional<long> steps, sheets_per_layer;
  std::string pitch_direction, book; ///< no default: each may double what the joint bears
  std::string bands = "each";        ///< "each" or "mean"

  double density = 7650.0;                         ///< kg/m³, of the sheets
  std::string centre_of_gravity = "of_the_sheets"; ///< or "as_given" by the body

  double pressure = 0.0; ///< Pa; 0: [[clamp]] tables make it
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
  std::optional<double> bottom_pressure, bottom_static_friction, bottom_kinetic_friction;
  std::vector<double> joint_pressure_shares; ///< of each joint, of all its pressures; none: all 1
  std::vector<double> bottom_joint_shares;   ///< at the bottom, if clamps make it another; no field of the table
  /// Pa/m outwards and away from the window, `pressure` being that at the middle of the mitre; at the bottom if different.
  std::optional<Vec2> pressure_gradient, bottom_pressure_gradient;
  std::string transverse_support;        ///< what holds the stack across: "both" faces, "front" or "back"
  std::optional<long> transverse_slices; ///< of each packet, whose pressures follow the acceleration on their own

  // Of the joints added, see step_lap_joint.
  std::optional<double> tangential_stiffness, contact_stiffness, shear_modulus; ///< N/m, N/m³, Pa
  std::optional<double> edge_stiffness, allowed_line_load;                      ///< N/m², N/m
  std::string pressure_signal, transverse_acceleration;                         ///< signals
  double pressure_loss = 0.0;
  std::string mode = "slip", on_apart = "stop";   ///< of the joints added
  std::optional<double> least_margin, most_slide; ///< of the joints added

  [[nodiscard]] bool is_counted() const { return overlap || interfaces; }
  [[nodiscard]] bool is_elastic() const { return tangential_stiffness || contact_stiffness; }
  [[nodiscard]] bool has_strips() const { return sheet_outlines == "strips"; }
  [[nodiscard]] bool is_middle(std::size_t limb) const { return limb >= limbs.size(); }
  /// Outer limbs, then middle ones.
  [[nodiscard]] std::vector<std::string> all_limbs() const;
  [[nodiscard]] std::string joint_name(std::size_t limb) const;
  /// Its share of the clamping pressures at that end.
  [[nodiscard]] double joint_share(std::size_t limb, bool is_top) const {
    const std::vector<double>& shares = is_top || bottom_joint_shares.empty() ? joint_pressure_shares : bottom_joint_shares;
    return limb < shares.size() ? shares[limb] : 1.0;
  }
};

[[nodiscard]] const TableKind& core_kind();

} // namespace steplap
