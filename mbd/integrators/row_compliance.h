// Velocities that forces along the friction rows cause within a time step.
//
// The change C_ij of the rate of row i by a unit force along row j is p_i·l_j, with two sparse vectors for each row (stage_system.h). The
// rates of all rows for given forces w are p_i·s with s = Σ l_j w_j, so that a change of one force costs as much as its vector has entries.
// C itself, which is full as soon as anything joins the bodies, is not computed.
#pragma once

#include "mbd/integrators/stage_system.h"

namespace steplap {

/// Compliance of a set of rows, and the sum s of the forces that act along them.
class RowCompliance {
public:
  /// Computes the vectors of the rows. `stages` must be factorised, and must stay so.
  void set(StageSystem& stages, const std::vector<ForceRow>& rows);
  /// Returns C_ij, m/s per N (rad and N m for rotations).
  [[nodiscard]] double between(int i, int j) const;

  /// Sets the forces along all rows, N or N m.
  void apply(const std::vector<double>& forces);
  /// Changes the force along one row.
  void add(int row, double change);
  /// Returns the rate of a row by the forces, m/s or rad/s.
  [[nodiscard]] double rate(int row) const;
  /// Computes the change of coordinates and velocities by the forces (StageSystem::finish_forces).
  void response(double* u) const { stages_->finish_forces(sum_.data(), u); }

private:
  StageSystem* stages_ = nullptr;
  SparseVectors force_, rate_; ///< l_j and p_i
  std::vector<double> sum_;    ///< s
};

} // namespace steplap
