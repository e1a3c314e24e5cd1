// Linearly dependent constraints, whose loads are statically indeterminate.
//
// If Jᵀ of all active rows (joints, drives, sticking friction) has null vectors n, then λ + n gives the same motion as λ: accelerations are
// unique, single multipliers are not. This class finds the null vectors in the coordinates of the bodies, independently of merging and
// locking, and provides
//
//   groups   sticking elements whose wrenches are not unique. A group sticks as long as an admissible distribution exists (least_usage.h);
//            it has common event functions.
//   reports  one distribution of many: friction carries what joints cannot, in proportion to its capacities (LeastUsage::settled); joints
//            have the least Σ A_rr λ_r², where A_rr = J_r M⁻¹ J_rᵀ is the acceleration by a unit multiplier.
//
// Null vectors depend on the pose, but remain valid while the bodies do not move relative to each other, which callers check by holds_at().
// SchurSolver decides which friction rows count as dependent, and leaves these out of the equations. Each row left out has one null vector.
// Other friction rows have none, except those of merged joints parallel to bilateral rows, which are exactly dependent.
#pragma once

#include "mbd/dynamics/least_usage.h"
#include "mbd/system/system.h"

#include <memory>
#include <vector>

namespace steplap {

/// Sticking elements that share a load, so that their wrenches are not unique.
struct SharingGroup {
  std::vector<int> frictions;
  std::vector<int> slot; ///< index in Snapshot::friction_force of each row
  LeastUsage least;
};

/// Wrench of an element at the moment when its group starts to slip.
struct Release {
  int friction = 0;
  double wrench[3] = {0, 0, 0}; ///< on the boundary of the admissible set
};

/// Groups of sticking elements that share a load, for one set of modes.
class LoadSharing {
public:
  /// Finds the null vectors at the poses `motion` of all bodies, with the phases of `state`. `left_out`: for each index of
  /// Snapshot::friction_force, whether the row is left out of the equations.
  LoadSharing(const System& system, const State& state, const std::vector<Motion<double>>& motion, std::vector<char> left_out);

  [[nodiscard]] const std::vector<SharingGroup>& groups() const { return groups_; }
  /// Returns true if an element that can slip sticks. If none does, there are no groups in any pose.
  [[nodiscard]] bool has_friction() const { return has_friction_; }
  /// Returns the index of the group that contains the friction element; −1 if its wrench is unique.
  [[nodiscard]] int group_of(int friction) const { return group_of_[friction]; }
  /// Returns true if the null vectors are still null vectors at these poses, and the same rows are left out.
  [[nodiscard]] bool holds_at(const std::vector<Motion<double>>& motion, const std::vector<char>& left_out) const;

  /// Returns the incompatibility of the motions along the rows of a group, relative to rounding errors; above 1 the elements cannot all
  /// stick. Dependent rows are compatible if Σ n_r (J_r v − target) = 0 for each null vector n, and the same for accelerations. Not
  /// compatible are the feet of a rocking box, and a drive and friction on the same coordinate.
  [[nodiscard]] double discord(int group, const Evaluation& evaluation, const double* acceleration) const;
  /// Computes the least utilisation of every group. `friction_force` contains one solution of the equations.
  void solve(const Evaluation& evaluation, const double* friction_force);
  /// Returns the elements of `group` that slip when its least utilisation exceeds 1. Precondition: solve().
  [[nodiscard]] std::vector<Release> releases(int group) const;
  /// Replaces the multipliers in both arrays, which contain one solution of the equations, by the distribution that is reported.
  /// Precondition: solve().
  void settle(double* row_force, double* friction_force) const;

private:
  /// An active row. `slot` is an index in friction_force for friction, otherwise in row_force.
  struct HeldRow {
    const RowSpec* spec = nullptr;
    int friction = -1, slot = 0;
    bool is_bounded = false;
    double norm = 0.0, mobility = 0.0;
  };
  /// A set of connected bodies, with the rows between them and the null vectors. Null vectors that load friction come first.
  struct ConnectedRows {
    std::vector<HeldRow> rows;             ///< rows with bounds (friction) last
    int free_count = 0;                    ///< number of rows without bounds
    MatX null;                             ///< rows × vectors
    VecX off;                              ///< for each null vector n: relative residual of Jᵀ n in the pose in which it was found
    int shared_count = 0;                  ///< number of vectors that load friction
    MatX settle;                           ///< coefficients of the other vectors that minimise the multipliers of unbounded rows
    std::vector<int> groups;               ///< indices of the groups among these bodies
    std::vector<std::vector<int>> columns; ///< for each group, the indices of its null vectors
  };
  void analyze(ConnectedRows& part, const std::vector<Motion<double>>& motion, std::vector<int>& body_index);
  [[nodiscard]] VecX off_balance(const ConnectedRows& part, const std::vector<Motion<double>>& motion) const;
  void make_groups(ConnectedRows& part, const std::vector<int>& pivots, const MatX& basis);
  [[nodiscard]] std::vector<HeldRow> held_rows(const State& state) const;

  const System& system_;
  std::vector<ConnectedRows> parts_;
  std::vector<SharingGroup> groups_;
  std::vector<int> group_of_;
  std::vector<char> left_out_;
  bool has_friction_ = false;
};

} // namespace steplap
