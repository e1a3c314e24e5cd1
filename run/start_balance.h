// Is what presses at the start answered by anything, or does it spring apart?
//
// With a(F) the accelerations that forces F give a machine on its joints, at rest and without friction, and g the gradient of a
// gap: all forces open it with g·a(Q), those that are no contacts' with g·a(Q₀). What settles under its loads begins with
// accelerations like these; a contact that is too deep opens with many times as much. Contacts that press against each other
// (a clamp) answer each other.
#pragma once

#include "mbd/rest/tangent.h"
#include "mbd/system/system.h"

namespace steplap {

/// The forces at the start of a run and the accelerations that they give; made once, asked for each contact.
class StartBalance {
public:
  /// In the pose of `state`, with nothing moving.
  StartBalance(const System& system, const State& state);

  /// How fast a coordinate begins to open.
  struct Opening {
    double acceleration = 0.0; ///< m/s² or rad/s², by all forces
    double by_loads = 0.0;     ///< by those that are no contacts', its size
  };
  /// Of a coordinate with this gradient (three numbers per body, the ground left out). `own`: a force along it that is no load
  /// either, a stop's.
  [[nodiscard]] Opening opening(const VecX& gradient, double own = 0.0) const;

  /// Gradient of the gap of a contact that presses, by the index of its force; empty if that one does not press.
  [[nodiscard]] VecX gap_gradient(int contact) const;
  /// Gradient of what a row measures: three numbers per body, the ground left out.
  [[nodiscard]] VecX gradient(const RowSpec& row) const;

private:
  [[nodiscard]] VecX acceleration(const VecX& force) const;
  [[nodiscard]] VecX contact_forces(const System& system) const;

  State state_;
  Statics statics_;
  VecX scale_, mass_; ///< mass_: of the scaled coordinates
  MatX free_;         ///< motions that joints allow, scaled; empty: all
  MatX inverse_;      ///< of their masses
  VecX all_, loads_;  ///< accelerations under all forces, and under those that are no contacts'
  std::vector<PairJacobian> parts_;
};

} // namespace steplap
