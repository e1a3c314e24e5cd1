#include "elements/machinery/lift_curve.h"

#include "mbd/formula/enclosure.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_turn = 2.0 * std::numbers::pi;
constexpr double k_turn_digits = 1e-9;             // tolerance of a whole turn, rad, for angles with few digits in a file
constexpr double k_rounded_angle = 1e-12 * k_turn; // rounding error of an angle of the curve, rad
// AngleUnit in either direction that are searched for lobes if the lift is a formula without a period of one turn.
constexpr int k_turns = 20;

// Computes h'' at the points from the continuity of h'. In a periodic curve the last point equals the first.
std::vector<double> curvatures(const std::vector<Vec2>& p, bool is_periodic) {
  const auto n = static_cast<Eigen::Index>(p.size()), count = is_periodic ? n - 1 : n;
  std::vector<Eigen::Triplet<double>> entries;
  VecX right = VecX::Zero(count);
  const auto width = [&](Eigen::Index i) { return p[static_cast<std::size_t>(i + 1)].x() - p[static_cast<std::size_t>(i)].x(); };
  const auto slope = [&](Eigen::Index i) {
    return (p[static_cast<std::size_t>(i + 1)].y() - p[static_cast<std::size_t>(i)].y()) / width(i);
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    if (!is_periodic && (i == 0 || i == count - 1)) {
      entries.emplace_back(i, i, 1.0);
      continue;
    }
    const Eigen::Index left = i == 0 ? n - 2 : i - 1, after = is_periodic ? (i + 1) % count : i + 1,
                       before = is_periodic ? left % count : left;
    entries.emplace_back(i, before, width(left));
    entries.emplace_back(i, i, 2.0 * (width(left) + width(i)));
    entries.emplace_back(i, after, width(i));
    right[i] = 6.0 * (slope(i) - slope(left));
  }
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseLU<Eigen::SparseMatrix<double>> solver(matrix);
  const VecX solved = solver.solve(right);
  std::vector<double> found(solved.begin(), solved.end());
  if (is_periodic) found.push_back(found.front());
  return found;
}

// Divides turns into parts in which a formula is almost constant or close to a polynomial, so that the samples of a step show its shape.
// Enclosures are used instead of values at single angles, because one of these may lie on a lobe by chance.
class LobeSearch {
public:
  explicit LobeSearch(const FormulaTree& tree) : tree_(tree), enclosures_(tree.size()) {
    for (const FormulaNode& node : tree)
      if (node.op == FormulaOp::operand) operands_ = std::max(operands_, static_cast<std::size_t>(node.operand) + 1);
  }

  // Returns the ends of the parts of one turn, rad, ascending; none if steps of one radian suffice.
  std::vector<double> knots(int turn) {
    const double begin = turn * k_turn, end = begin + k_turn;
    const Interval all = enclosure(begin, end).range;
    least_ = k_least_lobe * (all.high - all.low);
    if (!std::isfinite(least_)) least_ = 0.0;
    narrowest_ = k_turn;
    knots_.clear();
    halve(begin, end);
    return narrowest_ > k_wide ? std::vector<double>{} : knots_;
  }

private:
  // rad: undivided parts wider than k_wide need no knots, because a step turns by at most one radian; parts narrower than k_narrowest are
  // not divided
  static constexpr double k_wide = 0.4, k_narrowest = 4e-4;
  static constexpr double k_least_lobe = 1e-4; // variation of the lift that counts as constant, relative to its range in this turn
  static constexpr double k_close = 0.1;       // error of the polynomial relative to its range; a lobe between samples is larger

  Enclosure<k_enclosure_degree> enclosure(double begin, double end) {
    std::array<double, k_enclosure_degree + 1> c{};
    c[0] = 0.5 * (begin + end);
    c[1] = 0.5 * (end - begin);
    using Angle = Enclosure<k_enclosure_degree>;
    const std::vector<Angle> operands(operands_, Angle::of_polynomial(c, k_rounded_angle));
    return evaluate<EnclosingNumbers<k_enclosure_degree>>(tree_, operands.data(), Angle::of_number(0.0), enclosures_.data());
  }
  void halve(double begin, double end) {
    const Enclosure<k_enclosure_degree> lift = enclosure(begin, end);
    const double size = lift.range.high - lift.range.low;
    narrowest_ = std::min(narrowest_, end - begin);
    if (end - begin < k_narrowest || size <= least_ || lift.rest <= k_close * size) return;
    const double middle = 0.5 * (begin + end);
    halve(begin, middle);
    knots_.push_back(middle);
    halve(middle, end);
  }

  const FormulaTree& tree_;
  std::size_t operands_ = 0;
  std::vector<double> knots_;
  std::vector<Enclosure<k_enclosure_degree>> enclosures_;
  double least_ = 0.0, narrowest_ = 0.0;
};

} // namespace

bool LiftCurve::is_whole_turn(const std::vector<Vec2>& points) {
  return std::abs(points.back().x() - points.front().x() - k_turn) <= k_turn_digits;
}

LiftCurve::LiftCurve(std::vector<Vec2> points)
    : points_(std::move(points)), curvature_(curvatures(points_, is_whole_turn(points_))), is_periodic_(is_whole_turn(points_)) {}

LiftCurve::LiftCurve(FormulaProgram formula, const FormulaTree& tree) : formula_(std::move(formula)) {
  LobeSearch search(tree);
  const std::vector<double> first = search.knots(0);
  is_periodic_ = true;
  for (int turn = -k_turns; turn <= k_turns; ++turn) {
    const std::vector<double> knots = search.knots(turn);
    is_periodic_ = is_periodic_ && knots.size() == first.size();
    formula_knots_.insert(formula_knots_.end(), knots.begin(), knots.end());
  }
  if (!is_periodic_) return;
  formula_knots_ = first;
  if (!first.empty()) formula_knots_.push_back(first.front() + k_turn);
}

std::vector<double> LiftCurve::knots() const {
  if (formula_) return formula_knots_;
  std::vector<double> angles;
  for (const Vec2& point : points_) angles.push_back(point.x());
  return angles;
}

Lift LiftCurve::at(double angle) const { return formula_ ? of_formula(angle) : of_points(angle); }

Lift LiftCurve::of_points(double angle) const {
  if (is_periodic_) angle -= k_turn * std::floor((angle - points_.front().x()) / k_turn);
  const auto after = std::upper_bound(points_.begin() + 1, points_.end() - 1, angle, [](double x, const Vec2& p) { return x < p.x(); });
  const auto i = static_cast<std::size_t>(after - points_.begin()) - 1;
  const double width = points_[i + 1].x() - points_[i].x(), first = curvature_[i], last = curvature_[i + 1], cubic = (last - first) / width;
  const double slope = (points_[i + 1].y() - points_[i].y()) / width - width * (2.0 * first + last) / 6.0;
  const double d = angle - points_[i].x();
  if (!is_periodic_ && d < 0.0) return {points_[i].y() + slope * d, slope, 0.0};
  if (!is_periodic_ && d > width) {
    const double end = slope + width * (first + 0.5 * cubic * width);
    return {points_[i + 1].y() + end * (d - width), end, 0.0};
  }
  return {points_[i].y() + d * (slope + d * (0.5 * first + d * cubic / 6.0)), slope + d * (first + 0.5 * d * cubic), first + d * cubic};
}

Lift LiftCurve::of_formula(double angle) const {
  using D = Dual<1>;
  thread_local std::vector<D> room;
  room.resize(std::max(room.size(), static_cast<std::size_t>(formula_->size())));
  const auto with_slope = [&](double x) {
    const D operand = D::variable(x, 0);
    return formula_->evaluate(&operand, D(0.0), 0, room.data(), static_cast<D*>(nullptr));
  };
  constexpr double k_step = 1e-5; // step of the difference, rad; half of the digits of a slope remain
  const D now = with_slope(angle);
  return {now.v, now.d[0], (with_slope(angle + k_step).d[0] - with_slope(angle - k_step).d[0]) / (2.0 * k_step)};
}

} // namespace steplap
