// What the step-lap joints of a model can bear, as they lie in the reference pose: before any run, for the screen and for programs.
// Wrenches and twists are about the limb's centre of gravity, in the active part's axes; points are from the active part's centre of
// gravity, in m.
#pragma once

#include "elements/step_lap/patch/required_pressure.h"
#include "elements/step_lap/step_lap_friction.h"
#include "elements/step_lap/step_lap_joint.h"
#include "run/loaded_model.h"

namespace steplap {

/// One joint. It refers to the model that it is of, which has to outlive it. Without interfaces its capacities are infinite, and no wrench uses
/// any of them.
struct JointView {
  const StepLapJoint* joint = nullptr;             ///< never nullptr
  std::vector<const StepLapInterface*> interfaces; ///< in the order of the model; none: it holds whatever it takes
  Patch patch;                                     ///< by the static coefficients; reference: the limb's centre of gravity
  std::vector<std::string> beside;                 ///< springs and ties between the same two bodies: "'tie plate' (tie)"
  std::vector<double> areas;                       ///< of one interface of each kind, m^2

  /// Friction while the limb slides along x (0), along y (1) or turns (2) and moves no other way, N or N m.
  [[nodiscard]] double sliding(int direction) const;
  /// The largest force along x or y through the limb's centre of gravity, or couple (2), that the joint holds by itself, N or N m: less
  /// than sliding() where the friction's centre is not the limb's.
  [[nodiscard]] double alone(int direction) const;
  /// What it takes to bear the wrench (N, N, N m) on the limb. Throws NumericalFailure where that is not found to the last digit.
  [[nodiscard]] RequiredPressure required(const Vec3& wrench) const;
};

/// All joints of the model, in its order.
[[nodiscard]] std::vector<JointView> joint_views(const LoadedModel& loaded);

} // namespace steplap
