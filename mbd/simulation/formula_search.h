// Formulas on which the motion depends: where in a step one of them does for an instant what neither end of the step shows.
//
// A condition of an action (`hypot(b.x - x, b.y) < r`, `b.x > 3 && b.x < 3.001`) may be true, and a force by formula (`exp(-b.x^2)`) may act,
// for as short a time as one likes, of which no stage of a step sees anything. So such formulas are not sampled but bounded, as extremes of
// formulas are (formula_extremes.h): their operands are polynomials with an error over the step (operand_curves.h), and of these the
// formula's tree makes an enclosure over any span (mbd/formula/enclosure.h). Each formula has a band:
//   condition             false
//   force, rate of state  its values at the ends and in the middle of the step, and three times their difference on either side
// A span in which the formula stays in its band for certain is passed; another is halved. What is undecided of a condition at a 1e-9 of the
// step, off the step's ends, is told, and leaves the verdict open. Forces are less closely searched: a hidden peak of less than a thousandth
// of what the formula may do in the step is let pass.
//
// Behind an event the comparison that has just changed is about to change back where its quantity touches zero. The event finder looks for that
// from a ten-thousandth of the next step on. So of the first step behind an event it is also asked where a comparison first differs from the
// mode, and a step that is too long for the event finder is cut.
//
// Most steps stay far away: there the bounds of operands by three places of the step are enough. Formulas that cannot rise and fall within
// an instant (FormulaProgram::may_peak) are not searched.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/operand_curves.h"
#include "mbd/system/actions.h"
#include "mbd/system/state_jacobian.h"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace steplap {

/// Finds, within a step, where the condition of an armed action becomes true, or a force or rate by formula leaves what the step shows of it.
class FormulaSearch {
public:
  /// Searches the formulas of `system`'s forces and states, and the conditions of `group`, which may be null. Refers to both.
  FormulaSearch(const System& system, const ActionGroup* group);

  /// True if no formula needs a search.
  [[nodiscard]] bool is_empty() const { return sought_.empty(); }
  /// Forgets the values at the end of the last step, because the state has jumped.
  void restart() {
    is_known_ = false;
    is_behind_event_ = true;
  }
  /// A place of the step made, in parts of it, where a formula is outside its band; 1: there is none. `is_armed`: by action; null: none is.
  /// The step has to bear a look.
  [[nodiscard]] double place_of_peak(Integrator& integrator, Dynamics& dynamics, const std::vector<char>* is_armed);
  /// s: where nobody could tell whether a condition was true for less than a 1e-9 of a step.
  [[nodiscard]] const std::optional<double>& undecided() const { return undecided_; }

private:
  static constexpr int k_degree = OperandCurves::k_degree;
  static constexpr int k_no_action = -1;
  struct Sought {
    int action = k_no_action; ///< whose condition it is; else a force's or a state's formula
    const FormulaTree* tree = nullptr;
    OperandCurves curves;
    std::array<std::vector<double>, 3> operands; ///< at the step's begin, in its middle, at its end
    std::vector<int> comparisons; ///< nodes of the tree by switch; -1: no comparison. Empty of a condition, and where there is none
    const FormulaProgram* program = nullptr;
    int unit = -1;
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity(); ///< its band

    [[nodiscard]] bool is_condition() const { return action != k_no_action; }
    [[nodiscard]] bool is_outside(double value) const { return value < low || value > high; }
    [[nodiscard]] bool may_be_outside(const Interval& range) const {
      return !range.is_empty() && !(range.low >= low && range.high <= high);
    }
  };
  struct Span {
    double begin = 0.0, end = 1.0;
  };

  void add(int action, const FormulaInMotion& in_motion);
  [[nodiscard]] double place_of_peak(Sought& sought, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] double first_change(Sought& sought, Integrator& integrator, Dynamics& dynamics);
  template <class Value> [[nodiscard]] static bool may_change(const Sought& sought, SwitchBits bits, const Value& value_at);
  [[nodiscard]] bool set_band(Sought& sought, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool may_be_outside_by_range(const Sought& sought, double t0, double t1);
  [[nodiscard]] Snapshot look(double theta, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] Interval range_over(const Sought& sought, const Span& span, double t0, double h);
  [[nodiscard]] bool may_be_outside_at(const Sought& sought, double theta, double t);
  [[nodiscard]] double value(const Sought& sought, const double* operands, double t) {
    return value_of(*sought.tree, operands, t, values_.data());
  }

  std::vector<Sought> sought_;
  bool has_forces_ = false;
  double t_last_ = 0.0;   ///< s, end of the last step that was looked at
  bool is_known_ = false; ///< its end is the begin of the next
  bool is_behind_event_ = true;
  double t_event_ = std::numeric_limits<double>::quiet_NaN(); ///< s: begin of the first step behind an event
  std::vector<double> y_, dy_, operands_, values_;
  std::vector<Enclosure<k_degree>> leaf_, node_;
  std::vector<Enclosure<0>> leaf_at_, node_at_;
  std::vector<Span> spans_;
  std::optional<double> undecided_;
};

} // namespace steplap
