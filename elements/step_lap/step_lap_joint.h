// Step-lap joint: a limb held to the active part by friction between overlapping sheets (paper 2.1.2).
//
// While it sticks, the limb a is held to the active part b by the three constraints (17)–(25) with the slid distances d_x, d_y and the
// angle θ_acc, and the two bodies are integrated as one. While it slides, friction acts over the overlap of the sheets at the present pose
// (step_lap_friction.h). The sheets are the step_lap_interface elements that name the joint; without any the joint never slips.
//
// An elastic joint (tangential_stiffness, or contact_stiffness of an interface) yields before it slides: a spring in series with the
// friction (step_lap_elastic.h), which for large stiffness tends to the rigid joint, the default. With edge_stiffness the edges of its
// sheets are in contact where a clearance has closed (step_lap_edges.h).
//
// Assumptions: pressures do not change during sliding, no friction at edges, motion in the plane of the sheets. Source: theory.md §4.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct StepLapJoint : Element {
  std::string limb, active_part;
  std::string mode = "slip";                  ///< "slip", or "monitor": never slides, but reports the utilisation
  std::string on_apart = "stop";              ///< effect on the run when the joint comes apart: "stop" or "continue"
  std::optional<double> tangential_stiffness; ///< stiffness of the whole joint in translation, N/m
  std::optional<double> contact_stiffness;    ///< stiffness of one interface per area, N/m³
  /// Thickness t, m, and shear modulus G, Pa, of a sheet, which add the compliance t/G.
  std::optional<double> sheet_thickness, shear_modulus;
  std::optional<double> edge_stiffness;    ///< line load per penetration, of all sheets at a corner, N/m²
  std::optional<double> allowed_line_load; ///< largest line load on all sheets at a corner together, N/m
  std::optional<double> steel_thickness;   ///< thickness of all sheets at a corner together, m; converts a line load to a pressure
  std::string pressure_signal;             ///< factor of all pressures as a function of time; empty: 1
  double pressure_loss = 0.0;              ///< fraction of all pressures lost by relaxation
  std::string transverse_acceleration;     ///< name of the signal of the acceleration across the sheets, m/s²; empty: none
  double least_margin = 1.0;               ///< smallest margin for which a run counts as "hold"
  double most_slide = 0.1; ///< displacement of a corner, relative to the width of its overlap, above which the joint is rejected
};

[[nodiscard]] inline bool is_elastic(const StepLapJoint& joint) {
  return joint.tangential_stiffness.has_value() || joint.contact_stiffness.has_value();
}

[[nodiscard]] const ElementKind& step_lap_joint_kind();

} // namespace steplap
