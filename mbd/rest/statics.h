// Forces, constraint rows and their exact derivatives with everything at rest: what statics asks of a scene.
//
// In the bodies' own coordinates (x, y, θ of every body but the ground), so that nothing hangs on how a run would
// merge or lock them: welds and drives are rows like others. Velocities are zero, and so are those of the drives: they
// hold their coordinates where the time of the state asks for them. Contacts and tables are in the modes that the
// pose gives. Friction that sticks is rows, friction that slips is a force at its bound against the slip.
//   Q + Jᵀλ = 0,   K = ∂(Q + Jᵀλ)/∂q at constant λ
#pragma once

#include "mbd/events/anchor.h"
#include "mbd/system/evaluation_arrays.h"

#include <Eigen/SparseCore>

#include <vector>

namespace steplap {

/// A row that holds: bilateral, or of friction that sticks.
struct StaticRow {
  const RowSpec* spec = nullptr;
  int row = -1;         ///< bilateral row, or −1
  int friction = -1;    ///< friction element, or −1
  int friction_row = 0; ///< slot in Snapshot::friction_force
};

class Statics {
public:
  explicit Statics(const System& system);

  /// Forces at `state`: poses, time, friction and memory are read; modes are set in it from the poses.
  void evaluate(State& state);
  /// The rows that hold in `state`, as of the last collect_rows(); bilateral ones first. `left_out`: per slot of
  /// Snapshot::friction_force, a row of friction that stays out, since it depends on others; empty: none.
  void collect_rows(const State& state, const std::vector<char>& left_out = {});
  [[nodiscard]] const std::vector<StaticRow>& rows() const { return rows_; }
  [[nodiscard]] int bilateral_count() const { return bilateral_count_; }

  // At the last evaluation; n = 3 (bodies − 1).
  [[nodiscard]] int coordinates() const { return n_; }
  [[nodiscard]] const VecX& force() const { return force_; } ///< Q
  [[nodiscard]] MatX gradient() const;                       ///< J
  [[nodiscard]] VecX off() const;                            ///< of each row from its target, m or rad
  [[nodiscard]] MatX stiffness(const VecX& lambda) const;    ///< K
  [[nodiscard]] MatX damping() const;                        ///< ∂Q/∂v
  // The same entry by entry; duplicates add up.
  using Entry = Eigen::Triplet<double, int>;
  void gradient(std::vector<Entry>& entries) const;
  /// Of K; without what a normal force changes of the friction that slides on it, if asked for.
  void stiffness(const VecX& lambda, std::vector<Entry>& entries, bool with_sliding = true) const;
  void damping(std::vector<Entry>& entries) const;
  [[nodiscard]] const Evaluation& evaluation() const { return evaluation_; }
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }
  /// Normal force of a contact, for whoever asks what friction would do with another.
  [[nodiscard]] double& contact_force(int contact) { return arrays_.contact_force[contact]; }
  /// Wrench of friction element f while it slips, along its rows.
  void slip_wrench(int f, double* wrench) const;

private:
  void set_modes(State& state);
  void add_sliding_forces();
  void add_sliding_stiffness(int f, const std::vector<PairJacobian>& parts, bool with_sliding, std::vector<Entry>& k) const;

  const System& system_;
  int n_ = 0, bilateral_count_ = 0;
  const State* state_ = nullptr;
  Evaluation evaluation_;
  FrictionScratches scratch_;
  std::vector<Motion<double>> motion_;
  mutable EvaluationArrays arrays_; ///< nobody asks for rates of inner states: at rest nothing flows
  std::vector<StaticRow> rows_;
  VecX force_;
};

/// Value of the target of `row` at rest at the time of `state`.
[[nodiscard]] double static_target(const RowSpec& row, const State& state);
/// Anchors the rows of friction element f at the pose of `state`.
void anchor_friction(const System& system, State& state, int f);

} // namespace steplap
