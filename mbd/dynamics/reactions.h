// What follows from accelerations, the third of the three parts of Dynamics: wrenches of joints inside clusters, forces
// of pins of mechanisms, of drives that lock a coordinate, and the accelerations of all bodies.
//
// Nothing here is needed to go on integrating but the forces of locks (their power) and those of merged joints that may
// give way (their watch values).
#pragma once

#include "mbd/dynamics/kinematics.h"

#include <vector>

namespace steplap {

class Reactions {
public:
  /// `force`: per slot, on clusters and the bodies that ride on them; the same memory for the life of this object.
  Reactions(const System& system, const Kinematics& kinematics, const BodyForce* force);

  /// Both must outlive the use of this object or be set anew.
  void use(const Layout& layout, const State& state);

  /// 3 of every body, from those of the clusters, 3 each.
  void find_accelerations(const double* cluster_a);
  /// Of joints inside clusters, which go to row_force() and friction_force(). `lambda`: per active row.
  void find_joints(const double* cluster_a, const double* lambda);
  /// Of the rows and rods by which members of mechanisms hang.
  void find_pins(const double* cluster_a, const double* lambda);
  /// Of active rows, of locks, and none where friction does not act. `a`: of the layout's coordinates.
  void take_rows(const double* a, const double* lambda);
  /// What is missing in the equation of motion of a locked coordinate.
  [[nodiscard]] double of_lock(const Lock& lock, const double* a, const double* lambda) const;

  [[nodiscard]] const std::vector<double>& acceleration() const { return acceleration_; }
  [[nodiscard]] std::vector<double>& row_force() { return row_force_; }           ///< of every bilateral row
  [[nodiscard]] std::vector<double>& friction_force() { return friction_force_; } ///< of every friction element's

private:
  void add_carried(const RowSpec& spec, double lambda);
  [[nodiscard]] double* multipliers_of(const RigidEdge& edge);

  const System& system_;
  const Motion<double>* motion_;
  const BodyForce* force_;
  const Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  std::vector<EdgeGeometry> edges_;     ///< of the layout's, in the present phases
  std::vector<double> acceleration_;    ///< 3 per body
  std::vector<BodyForce> wrench_;       ///< scratch of find_joints, in the clusters' axes
  std::vector<Pair<double>> pin_force_; ///< scratch of find_pins
  std::vector<double> row_force_, friction_force_;
};

} // namespace steplap
