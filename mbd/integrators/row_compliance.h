// Velocities caused by forces along the friction rows within a time step.
//
// The compliance C_ij, the change of the rate of row i by a unit force along row j, is p_i·l_j, with two sparse vectors for each row
// (stage_system.h). The rates of all rows for given forces w are p_i·s with s = Σ l_j w_j, so that changing one force costs as much as
// its vector l has entries. C itself is not computed: it is full as soon as the bodies are connected.
#pragma once

#include "mbd/integrators/stage_system.h"

namespace steplap {

/// Compliance of a set of rows, and the sum s for the present forces along them.
class RowCompliance {
public:
  /// Computes the vectors of the rows. Precondition: `stages` is factorised; it must stay unchanged while this object is used.
  void set(StageSystem& stages, const std::vector<ForceRow>& rows);
  /// Returns C_ij, m/s per N (rad and N m for rotations).
  [[nodiscard]] double between(int i, int j) const;

  /// Sets the forces along all rows, N or N m.
  void apply(const std::vector<double>& forces);
  /// Adds `change`, N or N m, to the force along one row.
  void add(int row, double change);
  /// Returns the rate of a row that the present forces cause, m/s or rad/s.
  [[nodiscard]] double rate(int row) const;
  /// Computes the change u of coordinates and velocities that the forces cause (StageSystem::finish_forces).
  void response(double* u) const { stages_->finish_forces(sum_.data(), u); }

private:
  StageSystem* stages_ = nullptr;
  SparseVectors force_, rate_; ///< l_j and p_i
  std::vector<double> sum_;    ///< s = Σ l_j w_j
};

} // namespace steplap
