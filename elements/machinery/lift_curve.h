// Lift of a cam as a function of its angle: a smooth curve through points, or a formula.
//
// The curve through points is the cubic spline with continuous second derivative. Points over exactly one turn with equal lifts at both
// ends make a periodic curve; otherwise the curvature at the ends is zero, and the curve continues linearly.
#pragma once

#include "mbd/base/types.h"
#include "mbd/formula/formula_program.h"

#include <limits>
#include <optional>
#include <vector>

namespace steplap {

/// h, h' and h'' at one angle.
struct Lift {
  double value = 0.0, slope = 0.0, curvature = 0.0;
};

/// The lift curve of one cam.
class LiftCurve {
public:
  LiftCurve() = default;
  /// Curve through at least two points [angle, lift] in ascending order of angle. A whole turn requires at least three, with the last lift
  /// equal to the first.
  explicit LiftCurve(std::vector<Vec2> points);
  /// Curve given by a formula whose operands are all the angle, without switches; `tree` is the same formula. The second derivative, used
  /// only in Jacobians, is a difference of first derivatives.
  LiftCurve(FormulaProgram formula, const FormulaTree& tree);

  /// Returns the lift and its derivatives at an angle, rad.
  [[nodiscard]] Lift at(double angle) const;
  /// Returns the angles of the points. For a formula: angles between which it is almost constant or close to a polynomial, none if steps of
  /// one radian show all lobes. If is_periodic(), the last is the first plus a whole turn.
  [[nodiscard]] std::vector<double> knots() const;
  /// Returns the angle, rad, beyond which, either way, a formula may have lobes that knots() do not tell; infinite: nowhere.
  [[nodiscard]] double searched_to() const { return searched_to_; }
  /// Returns true if the knots are the same in each turn.
  [[nodiscard]] bool is_periodic() const { return is_periodic_; }
  /// Returns true if the points span one whole turn.
  [[nodiscard]] static bool is_whole_turn(const std::vector<Vec2>& points);

private:
  [[nodiscard]] Lift of_points(double angle) const;
  [[nodiscard]] Lift of_formula(double angle) const;

  std::vector<Vec2> points_;
  std::vector<double> curvature_; ///< h'' at the points
  bool is_periodic_ = false;      ///< points or knots are the same in each turn
  std::optional<FormulaProgram> formula_;
  std::vector<double> formula_knots_;
  double searched_to_ = std::numeric_limits<double>::infinity();
};

} // namespace steplap
