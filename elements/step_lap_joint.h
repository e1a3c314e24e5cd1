// Step-lap joint: a limb held to the active part by friction between overlapped sheets (paper 2.1.2).
//
// Sticking, the limb a is held to the active part b by the three constraints (17)–(25) with the slid
// distances d_x, d_y and the angle θ_acc; the wrench on the limb is reported about its centre of
// gravity. While it sticks the two bodies are integrated as one. Source: physics.md §4.
#pragma once

#include "mbd/model.h"

namespace steplap {

struct StepLapJoint : Element {
  std::string limb, active_part;
};

[[nodiscard]] const ElementKind& step_lap_joint_kind();

} // namespace steplap
