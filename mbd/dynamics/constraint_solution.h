// The rows that hold, the second of the three parts of Dynamics: their gradients, what they are off their targets by,
// and the multipliers
//   J (a_f + W Jᵀλ) = γ,  A = J W Jᵀ   (29)–(31)
// for the clusters in absolute coordinates, the same with M⁻¹ for each mechanism (mechanism.h).
//
// The pattern (which rows, between which clusters, what is constant) is the layout's. Multipliers are those of the last
// solve() until the next one: nothing else writes them. What rows are off by has members of its own, and what is solved
// for on the way to a projection is scratch.
#pragma once

#include "mbd/dynamics/kinematics.h"

#include <vector>

namespace steplap {

/// Largest constraint residuals, m or rad (position) and m/s or rad/s (velocity).
struct Residual {
  double position = 0.0;
  double velocity = 0.0;
};

class ConstraintSolution {
public:
  explicit ConstraintSolution(const Kinematics& kinematics);

  /// Both must outlive the use of this object or be set anew.
  void use(Layout& layout, const State& state);

  // --- of an evaluation: at the motion placed, t that of the evaluation -----------------------------
  /// Gradients, biases and factors, which do not hang on forces: what is found before them is there when they are.
  void prepare();
  /// After prepare(). Adds W Jᵀλ to the accelerations `a` that forces alone give; those of mechanisms are found from
  /// `force`.
  void solve(double t, const BodyForce* force, double* a);
  /// Of the layout's active rows.
  [[nodiscard]] const std::vector<double>& multipliers() const { return multiplier_; }
  /// Of the targets of active rows that are driven, at the time of the last solve().
  [[nodiscard]] const std::vector<double>& target_rates() const { return target_rate_; }

  // --- of a projection ------------------------------------------------------------------------------
  /// Gradients, values and rates against the targets at the motion placed.
  void compare(double t);
  [[nodiscard]] const std::vector<double>& off() const { return off_; }
  [[nodiscard]] const std::vector<double>& rate_off() const { return rate_off_; }
  /// Largest of them. What friction that shares its rows with others is off by is a watch value (LoadSharing::discord).
  [[nodiscard]] Residual residual() const;
  void factor(double shift = 0.0);
  [[nodiscard]] bool is_factored() const { return is_factored_; }
  void forget_factors() { is_factored_ = false; }
  /// change −= W Jᵀ A⁻¹ r, for a number r per row: `change` then has r less of what the rows measure.
  void take_away(const double* r, double* change);
  /// J change, along a row.
  [[nodiscard]] double along(std::size_t row, const double* change) const;

  // --- of a row that is not active ------------------------------------------------------------------
  /// Gradient in the clusters' coordinates; returns the measure, its bias that of the clusters. Of one part of a longer row.
  MeasureValue<double> load(const RowSpec& spec, SchurRow& row) const;

private:
  void solve_mechanisms(const BodyForce* force, double* a);
  void accelerate_mechanism(Mechanism& m, const BodyForce* force, double* a);
  void respond(Mechanism& m, double* a);
  void drive(double t);
  void compare_row(std::size_t r, double t);
  // Of rows over more than two bodies what their parts add (row_parts.cpp): to γ, to what they are off by, to what is left
  // of `right` at the accelerations `a`, to the accelerations, and along a row.
  void pull_parts();
  void compare_parts();
  void take_part_accelerations(const double* a, double* right) const;
  void add_part_responses(const double* lambda, double* a) const;
  [[nodiscard]] double along_parts(std::size_t row, const double* change) const;

  const Motion<double>* motion_; ///< per slot
  Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  bool is_factored_ = false;
  std::vector<double> multiplier_, target_rate_; ///< per active row; the latter of those that are driven
  std::vector<double> off_, rate_off_, response_;
  std::vector<double> cluster_a_; ///< scratch, where some are in mechanisms
};

} // namespace steplap
