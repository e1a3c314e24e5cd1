// The lift of a cam over its angle: a smooth curve through points, or a formula.
//
// Through points the cubic spline with two continuous derivatives. Points over one whole turn whose lifts at its ends agree make a
// periodic curve; else its ends have no curvature, and beyond them it goes on straight.
#pragma once

#include "mbd/base/types.h"
#include "mbd/formula/formula_program.h"

#include <optional>
#include <vector>

namespace steplap {

/// h, h', h'' at one angle.
struct Lift {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};

class LiftCurve {
public:
  LiftCurve() = default;
  /// At least two points [angle, lift], ascending in angle; three at least, and the last lift that of the first, for one whole turn.
  explicit LiftCurve(std::vector<Vec2> points);
  /// A formula whose operands are the angle, without switches; `tree`: the same formula. Its second derivative, which only Jacobians ask for,
  /// is a difference of first ones.
  LiftCurve(FormulaProgram formula, const FormulaTree& tree);

  [[nodiscard]] Lift at(double angle) const;
  /// Angles of the points. Of a formula: angles between which it has no lobe that its values at both ends and in the middle do not show;
  /// the last is the first one a whole turn later. None of a formula without narrow lobes, or that a turn does not repeat.
  [[nodiscard]] std::vector<double> knots() const;
  /// Do the points span one whole turn?
  [[nodiscard]] static bool is_whole_turn(const std::vector<Vec2>& points);

private:
  [[nodiscard]] Lift of_points(double angle) const;
  [[nodiscard]] Lift of_formula(double angle) const;

  std::vector<Vec2> points_;
  std::vector<double> curvature_; ///< h'' at the points
  bool is_periodic_ = false;
  std::optional<FormulaProgram> formula_;
  std::vector<double> formula_knots_;
};

} // namespace steplap
