#include "mbd/simulation/operand_curves.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr int k_last = OperandCurves::k_degree;
constexpr double k_ulp = 0x1p-52;
// Relative rounding error of evaluated operands. If an operand has more, its last coefficients show this.
constexpr double k_floor = 8.0 * k_ulp;
// Rounding error of a polynomial shifted to another point, relative to the sum of its coefficients.
constexpr double k_shift_rounding = 32.0 * k_ulp;
constexpr double k_check = 0.6180339887498949; // position of the test point in a panel, far from all nodes
constexpr double k_safety = 2.0;       // safety factor of the extrapolated error, because coefficients never decrease exactly geometrically
constexpr double k_slowest_fall = 0.8; // ratio of successive coefficients above which the series has not converged
constexpr double k_halved = 0.7;       // if halving a panel does not reduce an error below this factor, the curve is not smooth
constexpr double k_rough = 0.25;       // an error above this fraction of the range makes the polynomial no better than the range itself

struct Tables {
  std::array<double, k_last + 1> node{};                              // nodes in s, ascending
  std::array<std::array<double, k_last + 1>, k_last + 1> transform{}; // matrix from values at nodes to Chebyshev coefficients
  std::array<std::array<double, k_last + 1>, k_last + 1> powers{};    // Chebyshev polynomials in powers of s
};

// Constructed before main(), so that threads need no synchronisation.
const Tables k_tables = [] {
  Tables t;
  for (int i = 0; i < k_last / 2; ++i) {
    t.node[i] = -portable::cos(std::numbers::pi * i / k_last);
    t.node[k_last - i] = -t.node[i];
  }
  for (int k = 0; k <= k_last; ++k)
    for (int i = 0; i <= k_last; ++i) {
      const double ends = (k == 0 || k == k_last ? 0.5 : 1.0) * (i == 0 || i == k_last ? 0.5 : 1.0);
      t.transform[k][i] = ends * 2.0 / k_last * portable::cos(std::numbers::pi * k * (k_last - i) / k_last);
    }
  t.powers[0][0] = 1.0;
  t.powers[1][1] = 1.0;
  for (int k = 2; k <= k_last; ++k)
    for (int p = 0; p <= k_last; ++p) t.powers[k][p] = (p > 0 ? 2.0 * t.powers[k - 1][p - 1] : 0.0) - t.powers[k - 2][p];
  return t;
}();

OperandCurves::Coefficients chebyshev_of(const OperandCurves::Coefficients& values) {
  OperandCurves::Coefficients chebyshev{};
  for (int k = 0; k <= k_last; ++k)
    for (int i = 0; i <= k_last; ++i) chebyshev[k] += k_tables.transform[k][i] * values[i];
  return chebyshev;
}

OperandCurves::Coefficients powers_of(const OperandCurves::Coefficients& chebyshev) {
  OperandCurves::Coefficients c{};
  for (int k = 0; k <= k_last; ++k)
    for (int p = 0; p <= k; ++p) c[p] += k_tables.powers[k][p] * chebyshev[k];
  return c;
}

// Returns the sum of the omitted terms, if the coefficients continue to decrease as the last four do; even and odd coefficients are
// combined in pairs.
double left_out(const std::array<double, k_last + 1>& chebyshev) {
  const double last = std::max(std::abs(chebyshev[k_last]), std::abs(chebyshev[k_last - 1]));
  const double before = std::max(std::abs(chebyshev[k_last - 2]), std::abs(chebyshev[k_last - 3]));
  if (last == 0.0) return 0.0;
  const double fall = std::min(k_slowest_fall, before > 0.0 ? std::sqrt(last / before) : k_slowest_fall);
  return k_safety * 2.0 * fall / (1.0 - fall) * last;
}

double horner(const std::array<double, k_last + 1>& c, double s) {
  double sum = c[k_last];
  for (int k = k_last - 1; k >= 0; --k) sum = sum * s + c[k];
  return sum;
}

double size_of(const std::array<double, k_last + 1>& c) {
  double sum = 0.0;
  for (const double x : c) sum += std::abs(x);
  return sum;
}

} // namespace

OperandCurves::OperandCurves(std::vector<FormulaChannel::Leaf> leaves)
    : leaves_(std::move(leaves)), nodes_(k_nodes, std::vector<double>(leaves_.size())), check_(leaves_.size()), first_(leaves_.size()),
      middle_(leaves_.size()), last_(leaves_.size()) {}

void OperandCurves::read(const Snapshot& snapshot, double* values) const {
  for (std::size_t i = 0; i < leaves_.size(); ++i) values[i] = leaves_[i].factor * leaves_[i].value(snapshot);
}

int OperandCurves::add_panel(double begin, double end, int depth, int whole) {
  panels_.push_back({begin, end, -1, depth});
  curves_.resize(panels_.size() * leaves_.size());
  if (whole >= 0 && panels_[static_cast<std::size_t>(whole)].half < 0) panels_[static_cast<std::size_t>(whole)].half = panels() - 1;
  return panels() - 1;
}

void OperandCurves::begin_straight(const double* first, const double* last, const double* error) {
  panels_.clear();
  curves_.clear();
  (void)add_panel(0.0, 1.0, 0, -1);
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    Curve& curve = curves_[i] = {};
    curve.lacks_values = std::isnan(first[i]) || std::isnan(last[i]);
    curve.is_smooth = std::isfinite(first[i]) && std::isfinite(last[i]);
    curve.hull = {std::fmin(first[i], last[i]), std::fmax(first[i], last[i])};
    curve.c[0] = 0.5 * (first[i] + last[i]);
    curve.c[1] = 0.5 * (last[i] - first[i]);
    curve.error = error[i] + k_floor * (std::abs(first[i]) + std::abs(last[i]));
    curve.floor = curve.error;
  }
}

void OperandCurves::begin(const double* first, const double* last, const DenseEvaluation& evaluate_dense) {
  panels_.clear();
  curves_.clear();
  sample(add_panel(0.0, 1.0, 0, -1), evaluate_dense, first, last);
  for (std::size_t i = 0; i < leaves_.size(); ++i) fit(0, i, -1, check_[i]);
}

void OperandCurves::halve(int panel, const DenseEvaluation& evaluate_dense) {
  const Panel whole = panels_[static_cast<std::size_t>(panel)];
  const double middle = 0.5 * (whole.begin + whole.end);
  // Samples of the halved panel are not stored; three further evaluations are a small part of those that follow.
  read(evaluate_dense(whole.begin), first_.data());
  read(evaluate_dense(middle), middle_.data());
  read(evaluate_dense(whole.end), last_.data());
  for (const bool is_second : {false, true}) {
    const int half =
        is_second ? add_panel(middle, whole.end, whole.depth + 1, panel) : add_panel(whole.begin, middle, whole.depth + 1, panel);
    sample(half, evaluate_dense, is_second ? middle_.data() : first_.data(), is_second ? last_.data() : middle_.data());
    for (std::size_t i = 0; i < leaves_.size(); ++i) fit(half, i, panel, check_[i]);
  }
}

void OperandCurves::sample(int panel, const DenseEvaluation& evaluate_dense, const double* first, const double* last) {
  const Panel p = panels_[static_cast<std::size_t>(panel)];
  const double middle = 0.5 * (p.begin + p.end), half = 0.5 * (p.end - p.begin);
  std::copy_n(first, leaves_.size(), nodes_.front().begin());
  std::copy_n(last, leaves_.size(), nodes_.back().begin());
  for (int i = 1; i < k_last; ++i) read(evaluate_dense(middle + half * k_tables.node[i]), nodes_[i].data());
  read(evaluate_dense(p.begin + k_check * (p.end - p.begin)), check_.data());
}

void OperandCurves::fit(int panel, std::size_t leaf, int whole, double checked) {
  Coefficients value;
  Interval seen = interval::k_none;
  Curve curve;
  bool is_finite = true;
  const auto see = [&](double x) {
    curve.lacks_values = curve.lacks_values || std::isnan(x);
    is_finite = is_finite && std::isfinite(x);
    if (!std::isnan(x)) seen = interval::hull(seen, {x, x});
  };
  for (int i = 0; i < k_nodes; ++i) see(value[i] = nodes_[i][leaf]);
  see(checked);
  const double width = seen.high - seen.low, spread = std::isfinite(width) ? width : 0.0;
  curve.hull = seen.is_empty() ? seen : Interval{seen.low - spread, seen.high + spread};
  if (is_finite) {
    const Coefficients chebyshev = chebyshev_of(value);
    curve.c = powers_of(chebyshev);
    const double off = std::abs(horner(curve.c, 2.0 * k_check - 1.0) - checked);
    curve.floor = k_floor * std::max(std::abs(seen.low), std::abs(seen.high));
    curve.error = std::max(left_out(chebyshev), k_safety * off) + curve.floor;
    curve.is_smooth = curve.error <= std::max(k_rough * spread, 4.0 * curve.floor);
  }
  if (whole >= 0) {
    const Curve& before = this->curve(whole, leaf);
    const double now = curve.is_smooth ? curve.error : curve.hull.radius(), then = before.is_smooth ? before.error : before.hull.radius();
    curve.is_halving = curve.lacks_values || !(now > k_halved * then);
  }
  curves_[static_cast<std::size_t>(panel) * leaves_.size() + leaf] = curve;
}

bool OperandCurves::can_improve(int panel, std::size_t leaf) const {
  const Curve& c = curve(panel, leaf);
  if (c.hull.is_empty() || !c.is_halving) return false;
  return c.is_smooth ? c.error > 2.0 * c.floor : !(c.hull.radius() <= 2.0 * c.floor);
}

double OperandCurves::node(int i) { return k_tables.node[i]; }

OperandCurves::Coefficients OperandCurves::polynomial_through(const Coefficients& values) { return powers_of(chebyshev_of(values)); }

Enclosure<OperandCurves::k_degree> OperandCurves::part_of(const Coefficients& polynomial, double middle, double half, double error) {
  middle = std::clamp(middle, -1.0, 1.0);
  Coefficients c = polynomial;
  for (int k = 0; k < k_degree; ++k) // shifts the polynomial to the middle of the interval, by repeated division
    for (int i = k_degree - 1; i >= k; --i) c[i] += middle * c[i + 1];
  half += 4.0 * k_ulp; // because the ends of the interval are rounded in s
  double power = 1.0;
  for (double& x : c) {
    x *= power;
    power *= half;
  }
  return Enclosure<k_degree>::of_polynomial(c, error + k_shift_rounding * size_of(polynomial));
}

Enclosure<OperandCurves::k_degree> OperandCurves::over(int panel, std::size_t leaf, double begin, double end) const {
  const Curve& curve = this->curve(panel, leaf);
  if (!curve.is_smooth) return Enclosure<k_degree>::of_range(curve.hull, curve.lacks_values);
  const Panel& p = this->panel(panel);
  const double scale = 2.0 / (p.end - p.begin);
  return part_of(curve.c, scale * (0.5 * (begin + end) - p.begin) - 1.0, 0.5 * scale * (end - begin), curve.error);
}

Enclosure<0> OperandCurves::at(int panel, std::size_t leaf, double theta) const {
  const Curve& curve = this->curve(panel, leaf);
  if (!curve.is_smooth) return Enclosure<0>::of_range(curve.hull, curve.lacks_values);
  const Panel& p = this->panel(panel);
  const double s = std::clamp(2.0 * (theta - p.begin) / (p.end - p.begin) - 1.0, -1.0, 1.0);
  return Enclosure<0>::of_polynomial({horner(curve.c, s)}, curve.error + k_shift_rounding * size_of(curve.c));
}

} // namespace steplap
