// Constraints that depend on each other, and the loads that they can share in more than one way.
//
// While Jᵀ of all rows that hold (joints, drives, sticking friction) has null vectors n, λ + n moves nothing: the
// motion is unique, the single multipliers are not. Found here, in the bodies' own coordinates, whatever a layout
// merges or locks:
//   groups   of sticking elements whose wrenches are not unique: such a group holds as long as some sharing is
//            admissible (least_usage.h), and is watched as one;
//   reports  one sharing out of many: friction bears what joints cannot, in proportion to its capacities
//            (LeastUsage::settled); joints share with the least Σ A_rr λ_r², A_rr = J_r M⁻¹ J_rᵀ the acceleration
//            that a multiplier gives alone.
// Null vectors hold for a pose; while the bodies that take part do not move against each other they stay, and
// whoever asks checks that (holds_at). Which rows of friction depend on others is not decided here but where the equations
// leave them out (SchurSolver): each row that is left out there has one null vector, and no other row of friction but those of
// joints that are merged beside bilateral ones, which depend exactly.
#pragma once

#include "mbd/dynamics/least_usage.h"
#include "mbd/system/system.h"

#include <memory>
#include <vector>

namespace steplap {

/// Sticking elements that share a load.
struct SharingGroup {
  std::vector<int> frictions;
  std::vector<int> slot; ///< per row: in Snapshot::friction_force
  LeastUsage least;
};

/// What an element of a group does when the group gives way.
struct Release {
  int friction = 0;
  double wrench[3] = {0, 0, 0}; ///< at the bound
};

class LoadSharing {
public:
  /// With `motion` of all bodies, in the phases of `state`. `left_out`: per slot of Snapshot::friction_force, the row is not
  /// in the equations.
  LoadSharing(const System& system, const State& state, const std::vector<Motion<double>>& motion, std::vector<char> left_out);

  [[nodiscard]] const std::vector<SharingGroup>& groups() const { return groups_; }
  /// Does anything stick that can slip? If not, there will be no groups in any pose.
  [[nodiscard]] bool has_friction() const { return has_friction_; }
  /// Index of the group of a friction element; −1: its wrench is its own.
  [[nodiscard]] int group_of(int friction) const { return group_of_[friction]; }
  /// Are the null vectors still null vectors, and all there are?
  [[nodiscard]] bool holds_at(const std::vector<Motion<double>>& motion, const std::vector<char>& left_out) const;

  /// Can the elements of `group` stick together? Rows that depend on each other hold together only if what they are
  /// held at does too, Σ n_r (J_r v − target) = 0 and the same of accelerations for every null vector n: the feet of a
  /// rocking box, or a drive and friction on one coordinate, do not. Above 1: they do not, by more than rounding.
  [[nodiscard]] double discord(int group, const Evaluation& evaluation, const double* acceleration) const;
  /// Solves every group for the wrenches in `friction_force`.
  void solve(const Evaluation& evaluation, const double* friction_force);
  /// Elements that slip when `group`, solved, gives way.
  [[nodiscard]] std::vector<Release> releases(int group) const;
  /// After solve(): of all sharings the one to report, in place. Both arrays must hold one sharing.
  void settle(double* row_force, double* friction_force) const;

private:
  /// One row that holds; `slot` in row_force, or in friction_force if it is friction's.
  struct HeldRow {
    const RowSpec* spec = nullptr;
    int friction = -1, slot = 0;
    bool is_bounded = false;
    double norm = 0.0, mobility = 0.0;
  };
  /// Rows between bodies that are connected, with their null vectors: first those that load friction.
  struct ConnectedRows {
    std::vector<HeldRow> rows;             ///< bounded ones last
    int free_count = 0;                    ///< rows that are not
    MatX null;                             ///< rows × vectors
    VecX off;                              ///< per vector: what it moved in the pose that it was found in, of its terms
    int shared_count = 0;                  ///< vectors that load friction
    MatX settle;                           ///< of the others: coefficients that take multipliers of the free rows to the least
    std::vector<int> groups;               ///< of this part
    std::vector<std::vector<int>> columns; ///< per group: its vectors
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
