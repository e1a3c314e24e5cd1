// Forces, constraint rows and their exact derivatives for a machine at rest.
//
// Coordinates are x, y, θ of every body except the ground. Unlike in a run, bodies are not merged or locked: welds and drives are ordinary
// rows. All velocities are zero. Drives hold their coordinates at the values for the time of the state. Contacts and tables have the modes
// of the pose. Sticking friction contributes rows; slipping friction exerts a force at its bound, opposed to the slip.
//   Q + Jᵀλ = 0,   K = ∂(Q + Jᵀλ)/∂q at constant λ
#pragma once

#include "mbd/events/anchor.h"
#include "mbd/system/evaluation_arrays.h"

#include <Eigen/SparseCore>

#include <vector>

namespace steplap {

/// An active row: of a joint or drive, or of sticking friction.
struct StaticRow {
  const RowSpec* spec = nullptr;
  int row = -1;         ///< bilateral row, or −1
  int friction = -1;    ///< friction element, or −1
  int friction_row = 0; ///< slot in Snapshot::friction_force
};

class Statics {
public:
  explicit Statics(const System& system);

  /// Evaluates forces at the poses, time, friction states and bases of rows in `state`. Sets the modes in `state` from the poses.
  void evaluate(State& state);
  [[nodiscard]] long evaluations() const { return evaluations_; } ///< number of calls of evaluate()
  /// Lists the rows that are active in `state`, those of joints and drives first. `left_out`: flags by friction row (slot in
  /// Snapshot::friction_force) of dependent rows to be omitted; empty: none.
  void collect_rows(const State& state, const std::vector<char>& left_out = {});
  [[nodiscard]] const std::vector<StaticRow>& rows() const { return rows_; }
  [[nodiscard]] int bilateral_count() const { return bilateral_count_; }

  // The following refer to the last evaluation; n = 3 (bodies − 1).
  [[nodiscard]] int coordinates() const { return n_; }
  [[nodiscard]] const VecX& force() const { return force_; } ///< Q
  [[nodiscard]] MatX gradient() const;                       ///< J
  [[nodiscard]] VecX off() const;                            ///< error of each row from its target, m or rad
  [[nodiscard]] MatX stiffness(const VecX& lambda) const;    ///< K
  [[nodiscard]] MatX damping() const;                        ///< ∂Q/∂v
  // Sparse forms of these matrices: the functions append entries, and entries at the same place add up.
  using MatrixEntry = Eigen::Triplet<double, int>;
  void gradient(std::vector<MatrixEntry>& entries) const;
  /// Appends the entries of K. `with_sliding`: includes the derivatives of sliding friction by normal forces.
  void stiffness(const VecX& lambda, std::vector<MatrixEntry>& entries, bool with_sliding = true) const;
  void damping(std::vector<MatrixEntry>& entries) const;
  [[nodiscard]] const Evaluation& evaluation() const { return evaluation_; }
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }
  /// Returns a reference to the normal force of a contact, which callers may change temporarily to find its effect on friction.
  [[nodiscard]] double& contact_force(int contact) { return arrays_.contact_force[contact]; }
  /// Writes the wrench, along its rows, of the slipping friction element f to `wrench`.
  void slip_wrench(int f, double* wrench) const;

private:
  void set_modes(State& state);
  void add_sliding_forces();
  void add_sliding_stiffness(int f, const std::vector<PairJacobian>& parts, bool with_sliding, std::vector<MatrixEntry>& k) const;

  const System& system_;
  int n_ = 0, bilateral_count_ = 0;
  long evaluations_ = 0;
  const State* state_ = nullptr;
  Evaluation evaluation_;
  FrictionScratches scratch_;
  std::vector<Motion<double>> motion_;
  mutable EvaluationArrays arrays_; ///< the rates of inner states in it are not used
  std::vector<StaticRow> rows_;
  VecX force_;
};

/// Returns the value that the row prescribes for its measure at rest, at the time of `state`.
[[nodiscard]] double static_target(const RowSpec& row, const State& state);
/// Sets the anchors of the rows of friction element f (RowSpec::base) to the pose of `state`.
void anchor_friction(const System& system, State& state, int f);

} // namespace steplap
