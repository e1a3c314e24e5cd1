// Search for the time within a step at which the condition of an action becomes true, for conditions that are nonlinear formulas of the
// motion (`hypot(b.x - x, b.y) < r`, `exp(-b.x^2) > 0.5`).
//
// Such a condition can be true for an arbitrarily short time, which no samples of values and slopes need to show. It is therefore bounded,
// as extremes of formulas are (formula_extremes.h): operands are polynomials with an error over the step (operand_curves.h), and the
// formula's tree gives an enclosure over any interval (mbd/formula/enclosure.h). An interval in which the condition is certainly false is
// dropped, any other is bisected, down to 1e-9 of the step. If the sign is still undecided there, and not at an end of the step, this is
// reported, and the verdict remains open.
//
// For most steps bounds of the operands from three points of the step suffice.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/operand_curves.h"
#include "mbd/system/actions.h"

#include <optional>
#include <vector>

namespace steplap {

/// Finds the time within a step at which the condition of an armed action becomes true.
class ConditionSearch {
public:
  /// Searches the conditions of `group`, which may be null. Keeps references to both arguments.
  ConditionSearch(const System& system, const ActionGroup* group);

  /// Returns true if no condition needs a search.
  [[nodiscard]] bool is_empty() const { return sought_.empty(); }
  /// Discards the values at the end of the last step. To be called after the state has jumped.
  void restart() {
    for (Sought& sought : sought_) sought.is_known = false;
  }
  /// Returns a point of the step, as a fraction of it, where the condition of an armed action is true, if it is false at the start of the
  /// step and the event finder may miss the change; 1 if there is none. Precondition: Integrator::bears_look().
  [[nodiscard]] double place_of_truth(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& is_armed);
  /// Returns the time, s, at which it remained undecided whether a condition was true for less than 1e-9 of a step; nothing if there was
  /// none.
  [[nodiscard]] const std::optional<double>& undecided() const { return undecided_; }

private:
  static constexpr int k_degree = OperandCurves::k_degree;
  struct Sought {
    std::size_t action = 0;
    const FormulaTree* tree = nullptr;
    OperandCurves curves;
    std::vector<double> first, middle, last; ///< operands at the start, in the middle and at the end of the step
    double t_last = 0.0;                     ///< time of `last`, s
    bool is_known = false;
  };
  struct Span {
    double begin = 0.0, end = 1.0;
  };

  [[nodiscard]] double place_of_truth(Sought& sought, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool may_be_true_by_range(const Sought& sought, double t0, double t1);
  [[nodiscard]] const Enclosure<k_degree>& enclose(const Sought& sought, const Span& span, double t0, double h);
  [[nodiscard]] bool may_be_true_at(const Sought& sought, double theta, double t);
  [[nodiscard]] bool is_true(const Sought& sought, const double* operands, double t);

  std::vector<Sought> sought_;
  std::vector<double> y_, dy_, operands_, values_;
  std::vector<Enclosure<k_degree>> leaf_, node_;
  std::vector<Enclosure<0>> leaf_at_, node_at_;
  std::vector<Span> spans_;
  std::optional<double> undecided_;
};

} // namespace steplap
