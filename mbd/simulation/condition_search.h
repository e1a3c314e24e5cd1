// Conditions of actions that are formulas other than linear in what they read (`hypot(b.x - x, b.y) < r`, `exp(-b.x^2) > 0.5`): where in a
// step one of them comes true, however short that is.
//
// Such a formula may be true for as short a time as one likes, of which neither values nor slopes beside it show anything. So it is not
// sampled but bounded, as extremes of formulas are (formula_extremes.h): its operands are polynomials with an error over the step
// (operand_curves.h), and of these the formula's tree makes an enclosure over any span (mbd/formula/enclosure.h). A span in which the
// condition is false for certain is passed; another is halved, down to a 1e-9 of the step. What is undecided then, off the step's ends,
// is told, and leaves the verdict open.
//
// Most steps stay far away: there the bounds of operands by three places of the step are enough.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/operand_curves.h"
#include "mbd/system/actions.h"

#include <optional>
#include <vector>

namespace steplap {

/// Finds, within a step, where the condition of an armed action becomes true.
class ConditionSearch {
public:
  /// Searches the conditions of `group`, which may be null. Refers to both.
  ConditionSearch(const System& system, const ActionGroup* group);

  /// True if no condition needs a search.
  [[nodiscard]] bool is_empty() const { return sought_.empty(); }
  /// Forgets the values at the end of the last step, because the state has jumped.
  void restart() {
    for (Sought& sought : sought_) sought.is_known = false;
  }
  /// A place of the step made, in parts of it, where the condition of an armed action is true that is false at the step's begin, and where
  /// the event finder may miss that; 1: there is none. The step has to bear a look.
  [[nodiscard]] double place_of_truth(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& is_armed);
  /// s: where nobody could tell whether a condition was true for less than a 1e-9 of a step.
  [[nodiscard]] const std::optional<double>& undecided() const { return undecided_; }

private:
  static constexpr int k_degree = OperandCurves::k_degree;
  struct Sought {
    std::size_t action = 0;
    const FormulaTree* tree = nullptr;
    OperandCurves curves;
    std::vector<double> first, middle, last; ///< operands at the step's begin, in its middle, at its end
    double t_last = 0.0;                     ///< s, of `last`; nothing is known before the first step
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
