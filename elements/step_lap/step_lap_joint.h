// Step-lap joint: a limb held to the active part by friction between overlapped sheets (paper 2.1.2).
//
// Sticking, the limb a is held to the active part b by the three constraints (17)–(25) with the slid
// distances d_x, d_y and the angle θ_acc, and the two bodies are integrated as one; sliding, friction acts
// over the overlap of the sheets at the present pose (step_lap_friction.h). The sheets come from the
// step_lap_interface elements that name the joint; without any it holds whatever it takes.
// An elastic joint (tangential_stiffness, or contact_stiffness of an interface) yields before it slides: a spring in series
// with the friction (step_lap_elastic.h), whose limit for large stiffness is the joint that sticks exactly, the default.
// With edge_stiffness the edges of its sheets bear on each other where a clearance has closed (step_lap_edges.h).
// Assumes pressure on each interface that does not change while sliding, no friction between edges, and motion in the
// plane of the sheets only. Source: physics.md §4.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct StepLapJoint : Element {
  std::string limb, active_part;
  std::string mode = "slip";                            ///< "slip" or "monitor": never slides, reports what it would take
  std::string on_apart = "stop";                        ///< "stop" or "continue"
  std::optional<double> tangential_stiffness;           ///< N/m, of the whole joint in translation
  std::optional<double> contact_stiffness;              ///< N/m³: of one interface, a square metre of it
  std::optional<double> sheet_thickness, shear_modulus; ///< m, Pa: what a sheet adds to its compliance, t/G
  std::optional<double> edge_stiffness;                 ///< N/m²: line load over depth, of all sheets at a corner
  std::optional<double> allowed_line_load;              ///< N/m, of all sheets at a corner
  std::optional<double> steel_thickness;                ///< m, of all sheets at a corner: a line load over it is a pressure
  std::string pressure_signal;                          ///< factor of all pressures in time; empty: 1
  double pressure_loss = 0.0;                           ///< share of all pressures that is lost by relaxation
  std::string transverse_acceleration;                  ///< signal, m/s²; empty: none
  double least_margin = 1.0;                            ///< that a run must leave for the joint to be held good
  double most_slide = 0.1;                              ///< of a corner, of the width of its overlap: beyond, the joint is rejected
};

[[nodiscard]] inline bool is_elastic(const StepLapJoint& joint) {
  return joint.tangential_stiffness.has_value() || joint.contact_stiffness.has_value();
}

[[nodiscard]] const ElementKind& step_lap_joint_kind();

} // namespace steplap
