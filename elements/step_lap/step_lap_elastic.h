// The force of elastic step-lap joints: springs in series with friction (step_lap_friction.h), as force elements with
// modes and an inner state p, the relative pose as far as the sheets have slid.
//
//   W = −K (s − p) on the limb about its centre of gravity, active part's axes; stored ½ (s − p)ᵀK (s − p).
// Holding, p stands and the mode is valid while the wrench is within the limit surface; yielding, p flows along the
// surface's normal. The wrench is continuous everywhere, so that neither velocities nor accelerations jump: K is
// bounded, and nothing has to be decided together with other friction. Integration leaves u = 1 + its error while it
// yields: settle_inner() moves p along the strain onto the surface (radial return) and books what that dissipates,
// F·Δp. At a corner of the limit surface the direction of slip is a state, too, and p follows it: the direction tells the wrench
// however sharp the corner is. It comes apart where its overlaps have a hundredth of the capacity left that they had in the reference pose.
#pragma once

#include "elements/step_lap/step_lap_friction.h"
#include "mbd/system/state_jacobian.h"

namespace steplap {

/// Modes: holds, yields as its wrench tells, comes apart, yields along a direction that is a state; above them a bit for each
/// interface that has parted.
inline constexpr UnitMode k_elastic_holds = 0, k_elastic_yields = 1, k_elastic_apart = 2, k_elastic_follows = 3;
inline constexpr int k_elastic_parted = 2; ///< first of these bits

/// Which of the four it is.
[[nodiscard]] inline UnitMode elastic_state(UnitMode mode) { return mode & 3U; }

[[nodiscard]] inline FrictionPhase phase_of_elastic(UnitMode mode) {
  if (elastic_state(mode) == k_elastic_apart) return FrictionPhase::apart;
  return elastic_state(mode) == k_elastic_holds ? FrictionPhase::stick : FrictionPhase::slip;
}

class ElasticGripGroup final : public ForceGroup, public StateReader {
public:
  struct Entry {
    int a = k_ground, b = k_ground;            ///< limb, active part
    const StepLapFriction* friction = nullptr; ///< of the system, which owns both
    int inner = 0;                             ///< first of seven: p, the direction of slip, and 1 once it has come apart
    int link = 0, unit = 0, watch = 0;
  };
  static constexpr int k_watches = 3; ///< bound or flow; interfaces parted; how sharp the corner is
  std::vector<Entry> entries;

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>*) const override { return 0.0; }
  [[nodiscard]] double inner_energy(const Motion<double>* motion, const double* inner) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void add_inner_jacobian(const Evaluation& e, std::vector<InnerJacobian>& out) const override;
  void add_state_jacobian(const Evaluation& e, StateJacobian& out) const override;
  double settle_inner(const Evaluation& e, double* inner) const override;
  double enter_mode(int element, UnitMode to, const Evaluation& e, double* inner) const override;
  void start_inner(const Motion<double>* motion, double* inner) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void enter_links(LinkTable& links) override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind transition(UnitMode from, UnitMode to) const override;
  [[nodiscard]] bool stops_in(int element, UnitMode to) const override {
    return elastic_state(to) == k_elastic_apart && entries[element].friction->stops_when_apart();
  }
};

} // namespace steplap
