// Reactions, the third of the three parts of Dynamics: wrenches in joints inside clusters, forces of the pins of mechanisms, forces of
// drives on locked coordinates, and accelerations of all bodies.
//
// Integration needs only the forces of locks (for their power) and of merged joints that may slip (for their event functions). All others
// are results.
#pragma once

#include "mbd/dynamics/kinematics.h"

#include <vector>

namespace steplap {

/// Computes reactions for one set of motions and forces. It does not allocate.
class Reactions {
public:
  /// `force`: forces on clusters and their bodies, by slot. The pointer must remain valid.
  Reactions(const System& system, const Kinematics& kinematics, const BodyForce* force);

  /// Sets layout and state, which must exist until the next call of use().
  void use(const Layout& layout, const State& state);

  /// Computes the accelerations of all bodies (3 numbers each) from those of the clusters (3 each).
  void find_accelerations(const double* cluster_a);
  /// Computes the wrenches in joints inside clusters, and writes them to row_force() and friction_force(). `lambda`: multipliers of active
  /// rows.
  void find_joints(const double* cluster_a, const double* lambda);
  /// Computes the forces of the pins and rods of mechanisms, and writes them to row_force() and friction_force().
  void find_pins(const double* cluster_a, const double* lambda);
  /// Copies the multipliers of active rows to row_force() and friction_force(), adds the forces of locks, and sets inactive friction to
  /// zero. `a`: accelerations of the layout's coordinates.
  void take_rows(const double* a, const double* lambda);
  /// Returns the force, N or N m, that keeps a locked coordinate on its prescribed motion.
  [[nodiscard]] double of_lock(const Lock& lock, const double* a, const double* lambda) const;

  [[nodiscard]] const std::vector<double>& acceleration() const { return acceleration_; }
  [[nodiscard]] std::vector<double>& row_force() { return row_force_; }           ///< per bilateral row
  [[nodiscard]] std::vector<double>& friction_force() { return friction_force_; } ///< wrenches of all friction elements

private:
  void add_carried(const RowSpec& spec, double lambda);
  [[nodiscard]] double* multipliers_of(const RigidEdge& edge);

  const System& system_;
  const Motion<double>* motion_;
  const BodyForce* force_;
  const Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  std::vector<EdgeGeometry> edges_;     ///< per edge of the layout, for the present phases
  std::vector<double> acceleration_;    ///< 3 per body
  std::vector<BodyForce> wrench_;       ///< scratch of find_joints(), in the axes of the clusters
  std::vector<Pair<double>> pin_force_; ///< scratch of find_pins()
  std::vector<double> row_force_, friction_force_;
};

} // namespace steplap
