// Elastic step-lap joints: springs in series with friction (step_lap_friction.h), as force elements with modes and an inner state p, the
// slid part of the relative pose s.
//
//   W = −K (s − p) on the limb about its centre of gravity, in the axes of the active part; stored energy ½ (s − p)ᵀK (s − p).
//
// Holding: p is constant, valid while W is within the limit surface. Yielding: p moves along the normal of the surface. W is continuous,
// and K finite, so that velocities and accelerations do not jump, and the mode does not depend on other friction elements. While it yields,
// integration leaves u = 1 + error; project_inner() moves p along the strain onto the surface (radial return) and counts F·Δp as
// dissipated. At a corner of the limit surface the slip direction is a state, too, and p follows it; the wrench is a well-defined function
// of the direction even there. The joint comes apart when its overlaps have 1/100 of the capacity that they had in the reference pose.
#pragma once

#include "elements/step_lap/step_lap_friction.h"
#include "mbd/system/state_jacobian.h"

namespace steplap {

/// Modes of an elastic joint: holds; yields in the direction given by its wrench; has come apart; yields in the direction that is a state.
/// The higher bits mark interfaces that have separated.
inline constexpr UnitMode k_elastic_holds = 0, k_elastic_yields = 1, k_elastic_apart = 2, k_elastic_follows = 3;
inline constexpr int k_elastic_parted = 2; ///< position of the first bit for separated interfaces

/// Returns which of the four modes it is, without the bits for interfaces.
[[nodiscard]] inline UnitMode elastic_state(UnitMode mode) { return mode & 3U; }

[[nodiscard]] inline FrictionPhase phase_of_elastic(UnitMode mode) {
  if (elastic_state(mode) == k_elastic_apart) return FrictionPhase::apart;
  return elastic_state(mode) == k_elastic_holds ? FrictionPhase::stick : FrictionPhase::slip;
}

/// All elastic joints, as one force group.
class ElasticGripGroup final : public ForceGroup {
public:
  struct ElementData {
    int a = k_ground, b = k_ground;            ///< indices of the limb and of the active part
    const StepLapFriction* friction = nullptr; ///< friction of the joint, owned by the system
    /// Index of the first of seven inner states: p (3), direction of slip (3), and 1 after the joint has come apart.
    int inner = 0;
    int link = 0, unit = 0, first_event = 0;
  };
  /// Number of event functions; each becomes negative when its event occurs:
  /// 0  onset or end of yielding: 1 − u(W) while the joint holds, slip speed γ while it yields
  /// 1  separation of the next interface, or of the whole joint
  /// 2  start or end of a corner of the limit surface, where the slip direction is a state: from the radius of curvature (roundness())
  static constexpr int k_event_count = 3;
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const override;
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override;
  double project_inner(const Evaluation& e, double* inner) const override;
  double jump_inner(int element, UnitMode to, const Evaluation& e, double* inner) const override;
  void relax_inner(const Motion<double>* motion, double* inner) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_links(LinkTable& links) override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override;
  [[nodiscard]] bool ends_run_in(int element, UnitMode to) const override {
    return elastic_state(to) == k_elastic_apart && entries[element].friction->stops_when_apart();
  }
};

} // namespace steplap
