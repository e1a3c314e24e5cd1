// Model table [[core]]: step-lap joints between the limbs and yokes of a core, from its dimensions.
//
// Each limb has one step_lap_joint. At each of its corners there is one step_lap_interface for each kind of pair of neighbouring layers
// whose sheets overlap (stack.h). An interface has the outlines of these sheets (corner.h), in ground coordinates of the reference pose,
// and the number of such pairs. The origin of a limb's body frame is the middle of the limb: on its axis, at half the height of the core.
// Its centre of gravity is that of its sheets, and so are its mass and inertia unless they are given. An outer limb has one mitre at each
// end; a middle limb ends in a point between two mitres (T-joint).
//
// Assumptions: rectangular packets, pressure uniform or linear over a corner. Source and further assumptions: docs/reference/core.md.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Core : TableObject {
  std::string active_part;               ///< body that contains the yokes
  std::vector<std::string> limbs;        ///< bodies of the outer limbs
  std::vector<std::string> middle_limbs; ///< bodies of the middle limbs
  std::vector<std::string> joints;       ///< names of the joints of the limbs, outer ones first; default "<limb> joint"

  double core_height = 0.0;                                   ///< height of the packet with the highest yokes, including both yokes, m
  std::optional<double> limb_width, yoke_height, stack_depth; ///< dimensions of a core with one packet, m
  std::vector<Vec2> packets;                                  ///< width of the limb sheets and depth of each packet, front to back, m
  std::vector<double> yoke_heights;                           ///< height of the yoke in each packet, m
  std::vector<double> pressure_shares;                        ///< pressure of each packet, relative to `pressure`; none: all 1
  std::string yoke_steps = "both"; ///< sides on which the yokes of several packets are stepped: "both", "window" or "outside"
  std::vector<Vec2> ducts;         ///< position in the stack and width of each duct, m
  /// Positions of bolt holes from the intersection of the axes of limb and yoke, m: outwards, away from the window.
  std::vector<Vec2> bolt_holes;
  std::optional<double> bolt_hole_diameter; ///< diameter of the bolt holes, m
  std::optional<double> mitre_angle;        ///< angle of the mitre relative to the yoke, rad; default: from corner to corner
  std::optional<double> notch_angle;        ///< angle of both sides of a T-joint's point relative to the yoke, rad; default 45°

  // First way to define overlaps: counted and measured.
  std::optional<double> overlap, interfaces; ///< overlap, m; number of interfaces at a corner
  std::string sheet_outlines = "real";       ///< "real", or "strips" with square ends, as in the paper
  /// Dimensions of strips, m: extension of the sheet on both sides of the middle of the mitre; extension of the yoke sheet beyond the limb
  /// sheet at both ends of the mitre.
  std::optional<double> tongue, margin;
  // Second way to define overlaps: by the structure of the stack. Lengths in m.
  std::optional<double> sheet_thickness, stacking_factor, step_pitch, clearance;
  std::optional<long> steps, sheets_per_layer;
  std::string pitch_direction, book; ///< no default, because a wrong value can double the capacity of the joint
  std::string bands = "each"; ///< "each": every overlap of a book at its own position; "mean": one overlap of mean area for each packet

  double density = 7650.0;                         ///< density of the sheets, kg/m³
  std::string centre_of_gravity = "of_the_sheets"; ///< "of_the_sheets", or "as_given" in the body

  double pressure = 0.0; ///< clamping pressure, Pa; 0: from [[clamp]] tables
  double static_friction = 0.0;
  std::optional<double> kinetic_friction;
  std::optional<double> bottom_pressure, bottom_static_friction, bottom_kinetic_friction;
  std::vector<double> joint_pressure_shares; ///< pressure of each joint, relative to the pressures above; none: all 1
  std::vector<double> bottom_joint_shares;   ///< values for the bottom if clamps make them different; not a field of the table
  /// Pressure gradient outwards and away from the window, Pa/m, about the middle of the mitre, where the pressure is `pressure`; second
  /// value: at the bottom, if different.
  std::optional<Vec2> pressure_gradient, bottom_pressure_gradient;
  std::string transverse_support;        ///< support of the stack in transverse direction: "both" faces, "front" or "back"
  std::optional<long> transverse_slices; ///< number of slices of each packet, for pressures that depend on the transverse acceleration

  // Fields that are passed to the joints (step_lap_joint.h).
  std::optional<double> tangential_stiffness, contact_stiffness, shear_modulus; ///< in N/m, N/m³, Pa
  std::optional<double> edge_stiffness, allowed_line_load;                      ///< in N/m², N/m
  std::string pressure_signal, transverse_acceleration;                         ///< names of signals
  double pressure_loss = 0.0;
  std::string mode = "slip", on_apart = "stop";   ///< fields of the joints
  std::optional<double> least_margin, most_slide; ///< fields of the joints

  [[nodiscard]] bool is_counted() const { return overlap || interfaces; }
  [[nodiscard]] bool is_elastic() const { return tangential_stiffness || contact_stiffness; }
  [[nodiscard]] bool has_strips() const { return sheet_outlines == "strips"; }
  [[nodiscard]] bool is_middle(std::size_t limb) const { return limb >= limbs.size(); }
  /// Returns the names of all limbs, outer ones first.
  [[nodiscard]] std::vector<std::string> all_limbs() const;
  /// Returns the name of the joint of a limb.
  [[nodiscard]] std::string joint_name(std::size_t limb) const;
  /// Returns the factor of the clamping pressures of a joint at the top or bottom.
  [[nodiscard]] double joint_share(std::size_t limb, bool is_top) const {
    const std::vector<double>& shares = is_top || bottom_joint_shares.empty() ? joint_pressure_shares : bottom_joint_shares;
    return limb < shares.size() ? shares[limb] : 1.0;
  }
};

[[nodiscard]] const TableKind& core_kind();

} // namespace steplap
