#include "mbd/base/part_polynomial.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr std::size_t k_order = PartPolynomial::k_order;
using Values = PartPolynomial::Values;

// Factor of E. The Chebyshev coefficients of a function with a kink, such as the gap to a pin that is passed, decrease as 1/j²; the sum of
// the omitted ones is then at most this multiple of the last two. Those of a smooth function decrease much faster.
constexpr double k_tail = 4.0;
// E′/E. At the nodes T_j coincides with T_{12−j}, so the error contributed by T_j is T_j − T_{12−j}. Its slope on [−1, 1] is at most j² −
// (12 − j)²: 24 and 48 for j = 7 and 8. On [0, 1] it is twice that, for a coefficient that E counts at least twice.
constexpr double k_tail_slope = 48.0;
constexpr double k_least_coefficient = 1e-15; // relative to the largest value: smaller coefficients are rounding errors
// Largest number of bisections of a gap. Each one reduces the distance between Bernstein coefficients and polynomial by four, so at this
// depth it is 1e-12 of the curvature term. If the sign is still open then, the caller divides the interval.
constexpr int k_depth = 20;
constexpr int k_samples_of_gap = 8; // samples for bracketing the minimum
constexpr int k_sections = 40;      // golden-section steps, enough for the rounding error of the position

struct Table {
  Values node{}, between{};
  std::array<Values, k_order + 1> transform{}; // matrix from values to Chebyshev coefficients
  std::array<Values, k_order + 1> bernstein{}; // Bernstein coefficients of T_j on [0, 1]

  Table() {
    const double pi = std::numbers::pi;
    for (std::size_t k = 0; k <= k_order; ++k) {
      node[k] = 0.5 * (1.0 - portable::cos(pi * static_cast<double>(k) / k_order));
      between[k] = 0.5 * (1.0 - portable::cos(pi * (static_cast<double>(k) + 0.5) / k_order));
    }
    for (std::size_t j = 0; j <= k_order; ++j)
      for (std::size_t k = 0; k <= k_order; ++k) {
        double w = 2.0 / k_order * portable::cos(pi * static_cast<double>(j * (k_order - k)) / k_order);
        if (j == 0 || j == k_order) w *= 0.5;
        if (k == 0 || k == k_order) w *= 0.5;
        transform[j][k] = w;
      }
    for (std::size_t j = 0; j <= k_order; ++j) bernstein[j] = raised(of_chebyshev(j), j);
  }

  static double choose(std::size_t n, std::size_t k) {
    double c = 1.0;
    for (std::size_t i = 1; i <= k; ++i) c = c * static_cast<double>(n - k + i) / static_cast<double>(i);
    return c;
  }
  // T_n(2x − 1) = Σ_i (−1)^(n−i) C(2n, 2i)/C(n, i) B_i(x)
  static Values of_chebyshev(std::size_t n) {
    Values c{};
    for (std::size_t i = 0; i <= n; ++i) c[i] = ((n - i) % 2 == 0 ? 1.0 : -1.0) * choose(2 * n, 2 * i) / choose(n, i);
    return c;
  }
  // Degree elevation of Bernstein coefficients to degree k_order.
  static Values raised(Values c, std::size_t degree) {
    for (std::size_t n = degree; n < k_order; ++n) {
      Values up{};
      for (std::size_t i = 0; i <= n + 1; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(n + 1);
        up[i] = (i > 0 ? share * c[i - 1] : 0.0) + (i <= n ? (1.0 - share) * c[i] : 0.0);
      }
      c = up;
    }
    return c;
  }
};

const Table k_table; // constructed before main(), so threads need no synchronisation

// Subinterval of a gap (the interval between two neighbouring nodes). `length` is relative to [0, 1]; `begins_at_place` and
// `ends_at_place`: its end is a node, where p = f exactly.
struct SubInterval {
  Values c; // Bernstein coefficients of p
  double length;
  bool begins_at_place, ends_at_place;
};

// Divides a subinterval at the fraction `share` of its length (de Casteljau). Returns the Bernstein coefficients of the left part; `rest`
// receives those of the right part.
Values take_away(Values& rest, double share) {
  Values left;
  for (std::size_t n = 0; n <= k_order; ++n) {
    left[n] = rest[0];
    for (std::size_t i = 0; i + n < k_order; ++i) rest[i] += share * (rest[i + 1] - rest[i]);
  }
  return left;
}

struct Range {
  double least, most;
};

Range range_of(const SubInterval& s) {
  const auto [least, most] = std::minmax_element(s.c.begin(), s.c.end());
  return {*least, *most};
}

Range slopes_of(const SubInterval& s) {
  Range d{s.c[1] - s.c[0], s.c[1] - s.c[0]};
  for (std::size_t i = 1; i < k_order; ++i) {
    d.least = std::min(d.least, s.c[i + 1] - s.c[i]);
    d.most = std::max(d.most, s.c[i + 1] - s.c[i]);
  }
  return {k_order * d.least / s.length, k_order * d.most / s.length};
}

std::array<SubInterval, 2> halves(const SubInterval& s) {
  Values right = s.c;
  const Values left = take_away(right, 0.5);
  return {SubInterval{left, 0.5 * s.length, s.begins_at_place, false}, SubInterval{right, 0.5 * s.length, false, s.ends_at_place}};
}

bool is_above(const SubInterval& s, double floor, double error, int depth) {
  if (range_of(s).least >= floor + error) return true;
  const Range slopes = slopes_of(s);
  if (s.begins_at_place && s.c[0] >= floor && slopes.least > k_tail_slope * error) return true;
  if (s.ends_at_place && s.c[k_order] >= floor && slopes.most < -k_tail_slope * error) return true;
  const bool begins_in_doubt = !s.begins_at_place && s.c[0] < floor + error;
  const bool ends_in_doubt = !s.ends_at_place && s.c[k_order] < floor + error;
  if (depth == 0 || begins_in_doubt || ends_in_doubt) return false;
  const auto [left, right] = halves(s);
  return is_above(left, floor, error, depth - 1) && is_above(right, floor, error, depth - 1);
}

// Result so far of examining a gap from left to right for a single fall of f below the floor. `in_doubt`: more than one crossing cannot be
// excluded.
enum class FallState { above, falling, below, in_doubt };

FallState walk(const SubInterval& s, FallState so_far, double floor, double error, int depth) {
  if (so_far == FallState::below || so_far == FallState::in_doubt) return so_far;
  if (so_far == FallState::above && is_above(s, floor, error, 0)) return FallState::above;
  if (range_of(s).most <= floor - error) return FallState::below;
  if (slopes_of(s).most < -k_tail_slope * error) {
    if (s.c[k_order] >= floor + error) return FallState::above;
    return s.c[k_order] <= floor - error ? FallState::below : FallState::falling;
  }
  if (depth == 0) return FallState::in_doubt;
  const auto [left, right] = halves(s);
  return walk(right, walk(left, so_far, floor, error, depth - 1), floor, error, depth - 1);
}

} // namespace

double PartPolynomial::node(std::size_t k) { return k_table.node[k]; }

double PartPolynomial::between(std::size_t gap) { return k_table.between[gap]; }

void PartPolynomial::fit(const Values& values) {
  value_ = values;
  largest_ = 0.0;
  chebyshev_ = {};
  for (std::size_t k = 0; k <= k_order; ++k) {
    largest_ = std::max(largest_, std::abs(values[k]));
    for (std::size_t j = 0; j <= k_order; ++j) chebyshev_[j] += k_table.transform[j][k] * values[k];
  }
  error_ = k_tail * (std::abs(chebyshev_[k_order]) + std::abs(chebyshev_[k_order - 1]));
  if (error_ < k_least_coefficient * largest_) error_ = 0.0;
  Values rest{};
  for (std::size_t j = 0; j <= k_order; ++j)
    for (std::size_t i = 0; i <= k_order; ++i) rest[i] += chebyshev_[j] * k_table.bernstein[j][i];
  for (std::size_t gap = 0; gap < k_order; ++gap) {
    const double from = k_table.node[gap], to = k_table.node[gap + 1];
    bernstein_[gap] = gap + 1 < k_order ? take_away(rest, (to - from) / (1.0 - from)) : rest;
    bernstein_[gap][0] = values[gap]; // the value itself, without the rounding errors of the transform
    bernstein_[gap][k_order] = values[gap + 1];
  }
}

double PartPolynomial::at(double x) const {
  const double u = 2.0 * x - 1.0;
  double b1 = 0.0, b2 = 0.0;
  for (std::size_t j = k_order; j > 0; --j) {
    const double b = chebyshev_[j] + 2.0 * u * b1 - b2;
    b2 = b1;
    b1 = b;
  }
  return chebyshev_[0] + u * b1 - b2;
}

int PartPolynomial::first_uncertain_gap(double floor, std::size_t from, std::size_t to) const {
  for (std::size_t gap = from; gap < to; ++gap) {
    const SubInterval whole{bernstein_[gap], node(gap + 1) - node(gap), true, true};
    if (!is_above(whole, floor, error_, k_depth)) return static_cast<int>(gap);
  }
  return -1;
}

bool PartPolynomial::falls_once(double floor, std::size_t gap) const {
  const SubInterval whole{bernstein_[gap], node(gap + 1) - node(gap), true, true};
  return walk(whole, FallState::above, floor, error_, k_depth) != FallState::in_doubt;
}

double PartPolynomial::lowest(std::size_t from, std::size_t to) const {
  constexpr double k_golden = 0.3819660112501051;
  const int count = k_samples_of_gap * static_cast<int>(to - from);
  const double begin = node(from), step = (node(to) - begin) / count;
  int least = 0;
  for (int m = 1; m <= count; ++m)
    if (at(begin + m * step) < at(begin + least * step)) least = m;
  double low = begin + std::max(least - 1, 0) * step, high = begin + std::min(least + 1, count) * step;
  for (int i = 0; i < k_sections; ++i) {
    const double left = low + k_golden * (high - low), right = high - k_golden * (high - low);
    const bool is_left = at(left) < at(right);
    (is_left ? high : low) = is_left ? right : left;
  }
  return 0.5 * (low + high);
}

} // namespace steplap
