// Step-lap joint: a limb held to the active part by friction between overlapped sheets (paper 2.1.2).
//
// Sticking, the limb a is held to the active part b by the three constraints (17)–(25) with the slid
// distances d_x, d_y and the angle θ_acc, and the two bodies are integrated as one; sliding, friction acts
// over the overlap of the sheets at the present pose (step_lap_friction.h). The sheets come from the
// step_lap_interface elements that name the joint; without any it holds whatever it takes.
// Assumes uniform pressure on each interface that does not change while sliding, no butt contact of
// sheets of one layer, and motion in the plane of the sheets only. Source: physics.md §4.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct StepLapJoint : Element {
  std::string limb, active_part;
  std::string mode = "slip";     ///< "slip" or "monitor": never slides, reports what it would take
  std::string on_apart = "stop"; ///< "stop" or "continue"
  double least_margin = 1.0;     ///< that a run must leave for the joint to be held good
  double most_slide = 0.1;       ///< of a corner, of the width of its overlap: beyond, the joint is rejected
};

[[nodiscard]] const ElementKind& step_lap_joint_kind();

} // namespace steplap
