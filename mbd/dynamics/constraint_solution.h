// Active constraint rows, the second of the three parts of Dynamics: gradients J, residuals, and the multipliers λ from
//
//   J (a_f + W Jᵀλ) = γ,  A = J W Jᵀ   (29)–(31)
//
// with a_f the accelerations by forces alone, γ the bias terms, and W = M⁻¹ for clusters in absolute coordinates; for mechanisms
// (mechanism.h) the full M⁻¹ takes the place of W.
//
// The layout defines the pattern (which rows exist between which clusters) and all constants. multipliers() returns the result of the last
// solve(); projections use separate arrays.
#pragma once

#include "mbd/dynamics/kinematics.h"

#include <vector>

namespace steplap {

/// Largest constraint residuals, m or rad (position) and m/s or rad/s (velocity).
struct Residual {
  double position = 0.0;
  double velocity = 0.0;
};

/// Computes multipliers and projections for the rows of a layout. solve() and take_away() do not allocate.
class ConstraintSolution {
public:
  /// `kinematics` provides the motions, and must outlive it.
  explicit ConstraintSolution(const Kinematics& kinematics);

  /// Sets layout and state, which must exist until the next call of use().
  void use(Layout& layout, const State& state);

  // --- evaluation, at the present motion of `kinematics` ---------------------------------------------
  /// Computes gradients, bias terms and the factorisation of A at the present motion. None of these depends on the applied forces.
  void prepare();
  /// Solves for λ at time t and adds W Jᵀλ to `a`, which contains the accelerations by forces alone. The accelerations of mechanisms are
  /// computed completely, from `force`. Precondition: prepare().
  void solve(double t, const BodyForce* force, double* a);
  /// Returns λ, one number per active row of the layout, N or N m.
  [[nodiscard]] const std::vector<double>& multipliers() const { return multiplier_; }
  /// Returns the prescribed rates of the driven active rows at the time of the last solve(); entries of other rows are undefined.
  [[nodiscard]] const std::vector<double>& target_rates() const { return target_rate_; }

  // --- projection ------------------------------------------------------------------------------------
  /// Computes gradients and residuals of all rows at the present motion and time t.
  void compare(double t);
  /// Return value − target, and rate − target rate, for each active row.
  [[nodiscard]] const std::vector<double>& off() const { return off_; }
  [[nodiscard]] const std::vector<double>& rate_off() const { return rate_off_; }
  /// Returns the largest absolute residuals. Rows that are left out because they depend on others are not included; an event function
  /// monitors their residuals (LoadSharing::discord).
  [[nodiscard]] Residual residual() const;
  /// Factorises A, with its diagonal increased by the fraction `shift` (damping).
  void factor(double shift = 0.0);
  [[nodiscard]] bool is_factored() const { return is_factored_; }
  void forget_factors() { is_factored_ = false; }
  /// Subtracts W Jᵀ A⁻¹ r from `change`, with one number r for each row, so that J · change decreases by r.
  void take_away(const double* r, double* change);
  /// Returns J · change for one row.
  [[nodiscard]] double along(std::size_t row, const double* change) const;

  // --- single rows that need not be active -----------------------------------------------------------
  /// Computes gradient and inverse masses of one row, or of one part of a longer row, in the coordinates of the clusters. Returns the
  /// measure; its bias is that in these coordinates.
  MeasureValue<double> load(const RowSpec& spec, SchurRow& row) const;

private:
  void solve_mechanisms(const BodyForce* force, double* a);
  void accelerate_mechanism(Mechanism& m, const BodyForce* force, double* a);
  void solve_multipliers(Mechanism& m, double* a);
  void drive(double t);
  void compare_row(std::size_t r, double t);
  // Add the contributions of the further parts of rows over more than two bodies (row_parts.cpp): to γ and gradients, to residuals, to −J a
  // in `right`, to accelerations, and to J · change.
  void pull_parts();
  void compare_parts();
  void subtract_part_accelerations(const double* a, double* right) const;
  void add_part_responses(const double* lambda, double* a) const;
  [[nodiscard]] double along_parts(std::size_t row, const double* change) const;

  const Motion<double>* motion_; ///< per slot
  Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  bool is_factored_ = false;
  std::vector<double> multiplier_, target_rate_; ///< per active row; target_rate_ only for driven rows
  std::vector<double> off_, rate_off_, response_;
  std::vector<double> cluster_a_; ///< scratch for clusters in mechanisms
};

} // namespace steplap
