#include "elements/machinery/lift_curve.h"

#include "mbd/formula/enclosure.h"

#include <Eigen/SparseLU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace steplap {

namespace {

constexpr double k_turn = 2.0 * std::numbers::pi;
constexpr double k_turn_digits = 1e-9;             // tolerance of a whole turn, rad, for angles with few digits in a file
constexpr double k_rounded_angle = 1e-12 * k_turn; // rounding error of an angle of the curve, rad
constexpr int k_turns = 20;                        // either way that are searched one by one if the turns of a formula differ
constexpr long k_most_parts = 20000;               // beyond these turns, in each interval
constexpr double k_farthest = 1e6 * k_turn;        // rad: a formula that does not repeat itself is searched so far either way

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

using AngleEnclosure = Enclosure<k_enclosure_degree>;

std::size_t operand_count(const FormulaTree& tree) {
  int count = 0;
  for (const FormulaNode& node : tree)
    if (node.op == FormulaOp::operand) count = std::max(count, node.operand + 1);
  return static_cast<std::size_t>(count);
}

// Encloses the formula and all its nodes between two angles.
class EnclosedFormula {
public:
  explicit EnclosedFormula(const FormulaTree& tree) : tree_(tree), operands_(operand_count(tree)), nodes_(tree.size()) {}

  const AngleEnclosure& between(double begin, double end) {
    std::array<double, k_enclosure_degree + 1> c{};
    c[0] = 0.5 * (begin + end);
    c[1] = 0.5 * (end - begin);
    const double rounded = k_rounded_angle * std::max(1.0, std::abs(c[0]) / k_turn);
    const std::vector<AngleEnclosure> operands(operands_, AngleEnclosure::of_polynomial(c, rounded));
    return evaluate<EnclosingNumbers<k_enclosure_degree>>(tree_, operands.data(), AngleEnclosure::of_number(0.0), nodes_.data());
  }
  [[nodiscard]] const FormulaTree& tree() const { return tree_; }
  [[nodiscard]] const AngleEnclosure& node(std::size_t i) const { return nodes_[i]; }

private:
  const FormulaTree& tree_;
  std::size_t operands_;
  std::vector<AngleEnclosure> nodes_;
};

// Finds after how many turns a formula repeats itself: every angle in it stands, times a number, in a sine, cosine or tangent.
class PeriodSearch {
public:
  static constexpr int k_most = 64; // turns; a larger period is not looked for

  // Returns the number of turns; 0 if none was found.
  static int turns(EnclosedFormula& formula) {
    static_cast<void>(formula.between(-1.0, 1.0)); // in which a linear node a + b φ has the coefficients a and b
    std::vector<Part> parts;
    for (std::size_t i = 0; i < formula.tree().size(); ++i) parts.push_back(part(formula, i, parts));
    const Part& all = parts.back();
    return all.form == Form::periodic ? all.turns : 0;
  }

private:
  enum class Form { constant, linear, periodic, other };
  struct Part {
    Form form = Form::constant;
    int turns = 1;
  };

  static Part part(const EnclosedFormula& formula, std::size_t i, const std::vector<Part>& parts) {
    const FormulaNode& node = formula.tree()[i];
    if (node.op == FormulaOp::operand) return {Form::linear};
    if (node.op == FormulaOp::time) return {Form::other};
    Part sum;
    int linear = 0, dependent = 0;
    for (const int of : node.of) {
      if (of < 0) continue;
      const Part& each = parts[static_cast<std::size_t>(of)];
      if (each.form == Form::other) return {Form::other};
      dependent += each.form == Form::constant ? 0 : 1;
      linear += each.form == Form::linear ? 1 : 0;
      if (each.form == Form::periodic) sum = {Form::periodic, std::lcm(sum.turns, each.turns)};
    }
    if (linear == 0) return sum.turns <= k_most ? sum : Part{Form::other};
    if (linear < dependent) return {Form::other};
    return of_linear(formula, node);
  }

  // All operands are linear or constant.
  static Part of_linear(const EnclosedFormula& formula, const FormulaNode& node) {
    switch (node.op) {
    case FormulaOp::add:
    case FormulaOp::subtract:
    case FormulaOp::negate: return {Form::linear};
    case FormulaOp::multiply:
    case FormulaOp::divide: return is_scaled(formula, node) ? Part{Form::linear} : Part{Form::other};
    case FormulaOp::sin:
    case FormulaOp::cos:
    case FormulaOp::tan: return of_wave(formula.node(static_cast<std::size_t>(node.of[0])).c[1]);
    default: return {Form::other};
    }
  }
  // A product or quotient of linear nodes is linear if it has no higher terms, within rounding.
  static bool is_scaled(const EnclosedFormula& formula, const FormulaNode& node) {
    const auto index = static_cast<std::size_t>(&node - formula.tree().data());
    const AngleEnclosure& value = formula.node(index);
    return value.has_polynomial() && std::all_of(value.c.begin() + 2, value.c.end(), [](double c) { return c == 0.0; });
  }
  // A wave of `waves` radians per radian.
  static Part of_wave(double waves) {
    constexpr double k_digits = 1e-12; // rounding of a quotient such as value / 3
    for (int turns = 1; turns <= k_most; ++turns)
      if (std::abs(turns * waves - std::round(turns * waves)) <= k_digits * std::max(1.0, std::abs(turns * waves)))
        return {Form::periodic, turns};
    return {Form::other};
  }
};

// Divides angles until the formula is over each part either almost constant or close to a polynomial, whose shape the samples of a step
// show. Its values at some angles cannot decide that: one of them may lie on a lobe by chance.
class LobeSearch {
public:
  explicit LobeSearch(EnclosedFormula& formula) : formula_(formula) {}

  // Returns the ends of the parts between two angles, ascending; none if steps of one radian suffice.
  std::vector<double> knots(double begin, double end) {
    const AngleEnclosure& all = formula_.between(begin, end);
    const double size = all.range.high - all.range.low;
    const bool is_one_turn = end - begin <= 1.5 * k_turn;
    if (std::isfinite(size) && size > 0.0) lift_ = is_one_turn || lift_ == 0.0 ? std::max(lift_, size) : std::min(lift_, size);
    narrowest_ = end - begin;
    found_.clear();
    halve(begin, end);
    return narrowest_ > k_wide ? std::vector<double>{} : found_;
  }
  // Limits the number of parts in each further search.
  void allow_parts(long most) { parts_left_ = most; }
  [[nodiscard]] bool is_exhausted() const { return parts_left_ <= 0; }

private:
  // rad: undivided parts wider than k_wide need no knots, because a step turns by at most one radian; parts narrower than k_narrowest are
  // not divided
  static constexpr double k_wide = 0.4, k_narrowest = 4e-4;
  static constexpr double k_least_lobe = 1e-4; // of the lift in one turn
  static constexpr double k_close =
      0.1; // error of the polynomial relative to its range without the slope; a lobe between samples is larger

  void halve(double begin, double end) {
    if (--parts_left_ <= 0) return;
    const AngleEnclosure& lift = formula_.between(begin, end);
    narrowest_ = std::min(narrowest_, end - begin);
    if (end - begin < k_narrowest || is_smooth(lift)) return;
    const double middle = 0.5 * (begin + end);
    halve(begin, middle);
    found_.push_back(middle);
    halve(middle, end);
  }
  [[nodiscard]] bool is_smooth(const AngleEnclosure& lift) const {
    const double least = k_least_lobe * lift_;
    const double curved = std::accumulate(lift.c.begin() + 2, lift.c.end(), 0.0, [](double sum, double c) { return sum + std::abs(c); });
    const double size = lift.range.high - lift.range.low;
    return size <= least || lift.rest <= std::max(0.5 * least, k_close * std::min(size, curved));
  }

  EnclosedFormula& formula_;
  std::vector<double> found_;
  double lift_ = 0.0, narrowest_ = 0.0; ///< m in one turn; rad
  long parts_left_ = std::numeric_limits<long>::max();
};

// The knots of all turns of a period count in each turn, so that one turn repeats them.
std::vector<double> knots_of_period(EnclosedFormula& formula, int turns) {
  LobeSearch search(formula);
  std::vector<double> knots;
  for (int turn = 0; turn < turns; ++turn)
    for (const double knot : search.knots(turn * k_turn, (turn + 1) * k_turn)) knots.push_back(knot - turn * k_turn);
  std::sort(knots.begin(), knots.end());
  knots.erase(std::unique(knots.begin(), knots.end(), [](double a, double b) { return b - a <= k_turn_digits; }), knots.end());
  if (!knots.empty()) knots.push_back(knots.front() + k_turn);
  return knots;
}

// Searches turn by turn, then ever wider intervals: where a lift ends in a level or a slope, few parts cover all of them. `searched_to`
// receives the angle up to which the parts sufficed.
std::vector<double> knots_both_ways(EnclosedFormula& formula, double& searched_to) {
  LobeSearch search(formula);
  std::vector<double> knots;
  double to = 0.0;
  for (double width = k_turn; to < k_farthest; width = to < k_turns * k_turn ? k_turn : to) {
    if (width > k_turn) search.allow_parts(k_most_parts);
    const std::vector<double> behind = search.knots(to, to + width), before = search.knots(-to - width, -to);
    if (search.is_exhausted()) break;
    knots.insert(knots.begin(), before.begin(), before.end());
    knots.insert(knots.end(), behind.begin(), behind.end());
    to += width;
  }
  searched_to = to < k_farthest ? to : std::numeric_limits<double>::infinity();
  return knots;
}

} // namespace

bool LiftCurve::is_whole_turn(const std::vector<Vec2>& points) {
  return std::abs(points.back().x() - points.front().x() - k_turn) <= k_turn_digits;
}

LiftCurve::LiftCurve(std::vector<Vec2> points)
    : points_(std::move(points)), curvature_(curvatures(points_, is_whole_turn(points_))), is_periodic_(is_whole_turn(points_)) {}

LiftCurve::LiftCurve(FormulaProgram formula, const FormulaTree& tree) : formula_(std::move(formula)) {
  EnclosedFormula enclosed(tree);
  const int turns = PeriodSearch::turns(enclosed);
  is_periodic_ = turns > 0;
  formula_knots_ = is_periodic_ ? knots_of_period(enclosed, turns) : knots_both_ways(enclosed, searched_to_);
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
