// Search for short changes of formulas inside a step, which neither the stages nor the ends of the step show.
//
// A condition of an action (`hypot(b.x - x, b.y) < r`, `b.x > 3 && b.x < 3.001`) or a force by formula (`exp(-b.x^2)`) may act for an
// arbitrarily short time. Samples cannot exclude that, so the formula is bounded: its operands are polynomials with error bounds
// (operand_curves.h), and the formula's tree gives an enclosure over any span of the step (mbd/formula/enclosure.h). Each formula has a
// band:
//   condition                 false
//   force, rate of state      its polynomial of degree 8 through nine nodes of the step, ± 1e-3 of the range of the formula so far
//   the same, which switches  its values at the ends and in the middle of the step, extended on both sides by three times their range
// A span whose enclosure lies in the band is skipped, any other one is halved. If a condition is still undecided at 1e-9 of the step, away
// from the ends of the step, the verdict is open. The search for forces ends earlier. A formula switches if one of its comparisons, min, max
// or abs may change within the step: events locate that.
//
// After an event the comparison that changed may soon change back, but the event finder detects that only from 1e-4 of the next step on.
// The first step after an event is therefore searched for the first comparison that differs from the mode, and cut if it is too long for
// the event finder.
//
// For most steps, bounds of the operands from five points of the step exclude such changes: a condition stays false, or a formula differs
// from a polynomial of degree 4 by less than 1e-2 of its range. Formulas without short peaks (FormulaProgram::may_peak) are not searched.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/simulation/operand_curves.h"
#include "mbd/system/actions.h"
#include "mbd/system/motion_formula.h"

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace steplap {

/// Finds positions inside a step where the condition of an armed action becomes true, or a force or rate by formula leaves its band.
class FormulaPeakSearch {
public:
  /// Searches the formulas of forces and states of `system` and the conditions of `group`, which may be null. Both must outlive the search.
  FormulaPeakSearch(const System& system, const ActionGroup* group);

  /// Returns true if no formula needs a search.
  [[nodiscard]] bool is_empty() const { return sought_.empty(); }
  /// Discards the values at the end of the last step, because the state has jumped.
  void restart() {
    is_known_ = false;
    is_behind_event_ = true;
  }
  /// Returns a position in the last step, as a fraction of it, where a formula is outside its band; 1 if there is none. `is_armed`: a flag
  /// per action; null: none is armed. Precondition: Integrator::dense_output_is_accurate().
  [[nodiscard]] double place_of_peak(Integrator& integrator, Dynamics& dynamics, const std::vector<char>* is_armed);
  /// Returns the first time, s, at which a condition may have been true for less than 1e-9 of a step; empty if there was none.
  [[nodiscard]] const std::optional<double>& undecided() const { return undecided_; }

private:
  static constexpr int k_degree = OperandCurves::k_degree;
  static constexpr int k_no_action = -1;
  static constexpr std::size_t k_samples = 5, k_middle = 2, k_last = 4;
  struct MonitoredFormula {
    int action = k_no_action; ///< action with this condition; k_no_action for forces and states
    const FormulaTree* tree = nullptr;
    OperandCurves curves;
    std::array<std::vector<double>, k_samples> operands; ///< operands at evenly spaced points of the step, from its start to its end
    std::vector<int> comparisons; ///< per switch: its node in the tree; −1 if it is not a comparison. Empty for conditions
    const FormulaProgram* program = nullptr;
    int unit = -1; ///< index of the unit whose mode holds the outcomes of comparisons
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity(); ///< limits of the band
    bool is_about_polynomial = false;         ///< the band is one of the difference to `polynomial`
    OperandCurves::Coefficients polynomial{}; ///< in s, which goes from −1 to 1 over the step
    double scale = 0.0;                       ///< largest range of the formula over a step so far

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
  [[nodiscard]] double place_of_peak(MonitoredFormula& sought, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] double first_change(MonitoredFormula& sought, Integrator& integrator, Dynamics& dynamics);
  template <class Value> [[nodiscard]] static bool may_change(const MonitoredFormula& sought, SwitchBits bits, const Value& value_at);
  [[nodiscard]] bool is_resolved(MonitoredFormula& sought, double t0, double h);
  [[nodiscard]] bool may_switch(const MonitoredFormula& sought) const;
  [[nodiscard]] bool fit_polynomial(MonitoredFormula& sought, double t0, double h);
  [[nodiscard]] bool set_limits(MonitoredFormula& sought, double t0, double h);
  [[nodiscard]] bool set_band(MonitoredFormula& sought, double t0, double h);
  [[nodiscard]] bool may_be_outside_by_range(const MonitoredFormula& sought, double t0, double t1);
  [[nodiscard]] Snapshot evaluate_dense(double theta, Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] Enclosure<k_degree> enclosure_over(const MonitoredFormula& sought, const Span& span, double t0, double h);
  [[nodiscard]] Interval range_over(const MonitoredFormula& sought, const Span& span, double t0, double h);
  [[nodiscard]] bool may_be_outside_at(const MonitoredFormula& sought, double theta, double t);
  [[nodiscard]] double value_in_band(const MonitoredFormula& sought, const double* operands, double t, double theta);
  [[nodiscard]] double value(const MonitoredFormula& sought, const double* operands, double t) {
    return value_of(*sought.tree, operands, t, values_.data());
  }

  std::vector<MonitoredFormula> sought_;
  bool has_forces_ = false;
  double t_last_ = 0.0;                                       ///< end of the last step searched, s
  bool is_known_ = false;                                     ///< operands at t_last_ are known
  bool is_behind_event_ = true;                               ///< the next step is the first after an event
  double t_event_ = std::numeric_limits<double>::quiet_NaN(); ///< start of the first step after the last event, s
  std::vector<double> y_, dy_, operands_, values_;
  std::vector<Enclosure<k_degree>> leaf_, node_;
  std::vector<Enclosure<k_quartic>> leaf_quartic_, node_quartic_;
  std::vector<Enclosure<0>> leaf_at_, node_at_;
  std::vector<Span> spans_;
  std::optional<double> undecided_;
};

} // namespace steplap
