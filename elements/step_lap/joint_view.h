// Computes the friction capacity of the step-lap joints of a model in the reference pose at t = 0, before a run.
//
// Wrenches and twists are about the limb's centre of gravity, in the active part's axes. Points are relative to the active part's centre of
// gravity, m.
#pragma once

#include "elements/step_lap/patch/required_pressure.h"
#include "elements/step_lap/step_lap_friction.h"
#include "elements/step_lap/step_lap_joint.h"
#include "mbd/model/model.h"
#include "mbd/system/system.h"

namespace steplap {

/// One step-lap joint. Refers to the model and its system, which must outlive it. A joint without interfaces has infinite capacity and no
/// utilisation.
struct JointView {
  const StepLapJoint* joint = nullptr;             ///< never nullptr
  std::vector<const StepLapInterface*> interfaces; ///< in the order of the model; empty: the joint carries any load
  const StepLapFriction* friction = nullptr;       ///< compiled joint, part of the system; never nullptr
  Patch patch; ///< interfaces with their static coefficients, about the limb's centre of gravity, in the axes of `friction`
  std::vector<std::string> beside; ///< elements that connect the same two bodies in parallel: "'tie plate' (tie)"
  std::vector<double> areas;       ///< overlap area of each interface, m^2
  double pressure_factor = 1.0;    ///< factor of all pressures at t = 0, by `pressure_loss` and `pressure_signal`; `patch` is without it

  /// Returns the pressure of an interface at t = 0, Pa.
  [[nodiscard]] double pressure(std::size_t interface) const { return interfaces[interface]->pressure * pressure_factor; }
  /// Returns the centre of friction, m.
  [[nodiscard]] Vec2 centre() const { return friction->in_part(patch.centroid()); }
  /// Returns the friction force or couple if the limb slides purely along x (0), along y (1) or turns (2), N or N m.
  [[nodiscard]] double sliding(int direction) const;
  /// Returns the largest force along x (0) or y (1) through the limb's centre of gravity, or the largest couple (2), that the joint can
  /// carry, N or N m. A force can be smaller than sliding(), because it also exerts a couple on the joint if the centre of friction is not
  /// at the limb's centre of gravity.
  [[nodiscard]] double alone(int direction) const;
  /// Returns the pressure required to carry the wrench (N, N, N m) on the limb. Throws NumericalFailure if the solution does not converge.
  [[nodiscard]] RequiredPressure required(const Vec3& wrench) const;
};

/// Returns all step-lap joints of a completed model in its order. `system` is compiled from it.
[[nodiscard]] std::vector<JointView> joint_views(const Model& model, const System& system);

} // namespace steplap
