#include "mbd/simulation/node_polynomial.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr int k_points = NodePolynomial::k_last + 1;
// Largest number of divisions of a gap. A division at the maximum rarely needs more than two; 24 bisections reduce the error to 4^-24 of
// the differences of the coefficients.
constexpr int k_most_cuts = 24;
constexpr int k_newton_steps = 4; // Newton iterations for the maximum; from the position of a control point they converge to rounding
// Smallest distance of a division from an end, relative to the part; a nearer one would hardly reduce the larger piece.
constexpr double k_beside_an_end = 0.02;

using Coefficients = std::array<double, k_points>;

// Constructed before main(), so that threads need no synchronisation.
struct Tables {
  /// bernstein[l][j][k][i]: contribution of value i to Bernstein coefficient k in the gap after point j of level l.
  double bernstein[NodePolynomial::k_levels + 1][NodePolynomial::k_last][k_points][k_points] = {};
  /// bend[l][k][i]: contribution of Chebyshev polynomial T_k to the bound of |p″| on [0, 1] at level l, per unit of the sum (k even) or
  /// difference (k odd) of values i and n − i. |T_k″| ≤ k² (k² − 1)/3, and 4 times that on [0, 1].
  double bend[NodePolynomial::k_levels + 1][k_points][k_points] = {};

  Tables() {
    for (int level = 1; level <= NodePolynomial::k_levels; ++level) {
      const int n = 1 << level;
      for (int k = 2; k <= n; ++k)
        for (int i = 0; 2 * i <= n; ++i)
          bend[level][k][i] = (k == n ? 1.0 : 2.0) / n * (i == 0 ? 0.5 : 1.0) * portable::cos(std::numbers::pi * k * i / n) * k * k *
                              (k * k - 1) * 4.0 / 3.0;
    }
    for (int level = 1; level <= NodePolynomial::k_levels; ++level)
      for (int gap = 0; gap < 1 << level; ++gap)
        for (int i = 0; i <= 1 << level; ++i) set(level, gap, i);
  }

  // Computes the Bernstein coefficients of the Lagrange polynomial of point i in a gap, as a product of linear factors; each raises the
  // degree by one.
  void set(int level, int gap, int i) {
    const int step = NodePolynomial::spacing(level), n = 1 << level;
    const auto theta = [](int node) { return NodePolynomial::theta(node); };
    const double from = theta(gap * step), to = theta((gap + 1) * step);
    Coefficients b{1.0};
    int degree = 0;
    for (int k = 0; k <= n; ++k) {
      if (k == i) continue;
      const double scale = 1.0 / (theta(i * step) - theta(k * step));
      const double low = (from - theta(k * step)) * scale, high = (to - theta(k * step)) * scale;
      ++degree;
      for (int j = degree; j >= 0; --j)
        b[j] = ((degree - j) * low * (j < degree ? b[j] : 0.0) + j * high * (j > 0 ? b[j - 1] : 0.0)) / degree;
    }
    for (int k = 0; k <= n; ++k) bernstein[level][gap][k][i] = b[k];
  }
};

const Tables k_tables;

constexpr auto k_weights = [] {
  std::array<std::array<NodePolynomial::Weights, NodePolynomial::k_last / 2>, NodePolynomial::k_levels> tables{};
  for (int level = 1; level < NodePolynomial::k_levels; ++level)
    for (int gap = 0; gap < 1 << level; ++gap) {
      const int n = 1 << level, step = NodePolynomial::spacing(level);
      NodePolynomial::Weights& weights = tables[level][gap];
      double sign = 1.0;
      for (int i = 0; i <= n; ++i) {
        weights.of[i] =
            (i == 0 || i == n ? 0.5 : 1.0) * sign / (NodePolynomial::theta(gap * step + step / 2) - NodePolynomial::theta(i * step));
        weights.sum += weights.of[i];
        sign = -sign;
      }
    }
  return tables;
}();

// Data of three consecutive points: the two gaps, product = before · behind (before + behind), and the largest excess of their parabola
// over the points per unit of `down` (may_exceed()). In a gap of width w the excess is w²/4 times the leading coefficient.
struct Triple {
  double before = 0.0, behind = 0.0, product = 0.0, most = 0.0;
};

constexpr auto k_triples = [] {
  std::array<std::array<Triple, NodePolynomial::k_last>, NodePolynomial::k_levels + 1> triples{};
  for (int level = 1; level <= NodePolynomial::k_levels; ++level)
    for (int i = 1; i < 1 << level; ++i) {
      const int step = NodePolynomial::spacing(level);
      const double at = NodePolynomial::theta(i * step);
      const double before = at - NodePolynomial::theta((i - 1) * step), behind = NodePolynomial::theta((i + 1) * step) - at;
      const double wider = std::max(before, behind), product = before * behind * (before + behind);
      triples[level][i] = {before, behind, product, 0.25 * wider * wider / product};
    }
  return triples;
}();

// Searches the maximum of the polynomial in a gap.
class TopSearch {
public:
  TopSearch(int degree, double floor, double slack) : degree_(degree), best_(floor), slack_(slack) {}

  [[nodiscard]] bool is_below(double bound) const { return bound <= best_ + slack_; }

  // Searches the part of the gap that begins at `from` and has the given width, with Bernstein coefficients b.
  void subdivide(const Coefficients& b, double from, double width, int cuts) {
    take(b[0], from);
    take(b[degree_], from + width);
    if (is_below(*std::max_element(b.begin(), b.begin() + degree_ + 1)) || cuts == 0) return;
    const double s = place_of_top(b), t = 1.0 - s;
    Coefficients left, right = b;
    left[0] = b[0];
    for (int k = 1; k <= degree_; ++k) {
      for (int j = 0; j <= degree_ - k; ++j) right[j] = t * right[j] + s * right[j + 1];
      left[k] = right[0];
    }
    take(right[0], from + s * width);
    subdivide(left, from, s * width, cuts - 1);
    subdivide(right, from + s * width, t * width, cuts - 1);
  }

  void take(double value, double theta) {
    if (!(value > best_)) return;
    best_ = value;
    found_ = {value, theta};
  }

  [[nodiscard]] const std::optional<NodePolynomial::Top>& found() const { return found_; }

private:
  // Returns the position of the maximum, by Newton's method from the largest coefficient; the middle of the part if the iteration leads to
  // an end, or if the curvature is not that of a maximum.
  [[nodiscard]] double place_of_top(const Coefficients& b) const {
    const auto highest = std::max_element(b.begin(), b.begin() + degree_ + 1) - b.begin();
    double s = std::clamp(static_cast<double>(highest) / degree_, k_beside_an_end, 1.0 - k_beside_an_end);
    for (int step = 0; step < k_newton_steps; ++step) {
      Coefficients d; // coefficients of p′, without the factor n
      for (int j = 0; j < degree_; ++j) d[j] = b[j + 1] - b[j];
      for (int k = 1; k < degree_ - 1; ++k)
        for (int j = 0; j < degree_ - k; ++j) d[j] += s * (d[j + 1] - d[j]);
      const double bend = (degree_ - 1) * (d[1] - d[0]);
      if (!(bend < 0.0)) return 0.5;
      s -= (d[0] + s * (d[1] - d[0])) / bend;
      if (!(s > k_beside_an_end && s < 1.0 - k_beside_an_end)) return 0.5;
    }
    return s;
  }

  int degree_;
  double best_, slack_;
  std::optional<NodePolynomial::Top> found_;
};

} // namespace

// Barycentric interpolation.
double NodePolynomial::at(double theta) const {
  const int step = spacing(level_), n = 1 << level_;
  double above = 0.0, below = 0.0, sign = 1.0;
  for (int i = 0; i <= n; ++i) {
    const double distance = theta - NodePolynomial::theta(i * step);
    if (distance == 0.0) return values_[i];
    const double weight = (i == 0 || i == n ? 0.5 : 1.0) * sign / distance;
    above += weight * values_[i];
    below += weight;
    sign = -sign;
  }
  return above / below;
}

const NodePolynomial::Weights& NodePolynomial::weights_at(int level, double theta) {
  const int step = spacing(level), last = (1 << level) - 1;
  int gap = 0;
  while (gap < last && NodePolynomial::theta((gap + 1) * step) < theta) ++gap;
  return k_weights[level][gap];
}

bool NodePolynomial::may_exceed(double limit, double error, int level, const Values& values, double sign, double best) {
  constexpr double k_rounded = 1e-14; // rounding errors relative to the values, with a large margin
  if (!(best + error <= limit)) return true;
  const int n = 1 << level;
  for (int i = 1; i < n; ++i) {
    const double p = sign * (values[i] - values[i - 1]), q = sign * (values[i] - values[i + 1]);
    if ((p < 0.0 || q < 0.0) && i != 1 && i != n - 1) continue;
    const Triple& t = k_triples[level][i];
    const double down = p * t.behind + q * t.before; // leading coefficient of the parabola times the product
    if (!(down > 0.0)) continue;
    const double middle = sign * values[i], three = middle + std::max({0.0, -p, -q});
    if (three + 2.0 * t.most * down + k_rounded * (std::abs(middle) + std::abs(three)) + error <= limit)
      continue; // the limit is not exceeded, wherever the parabola has its maximum
    const double slope = (p * t.behind * t.behind - q * t.before * t.before) / t.product;
    const double curve = down / t.product, shift = std::clamp(0.5 * slope / curve, -t.before, t.behind);
    const double top = middle + shift * (slope - curve * shift);
    if (!(three + 2.0 * std::max(0.0, top - three) + error <= limit)) return true;
  }
  return false;
}

double NodePolynomial::largest_bend() const {
  const int n = 1 << level_;
  double sum = 0.0;
  Values even, odd;
  for (int i = 0; 2 * i < n; ++i) {
    even[i] = values_[i] + values_[n - i];
    odd[i] = values_[i] - values_[n - i];
  }
  even[n / 2] = values_[n / 2];
  odd[n / 2] = 0.0;
  for (int k = 2; k <= n; ++k) {
    const Values& folded = k % 2 == 0 ? even : odd;
    double part = 0.0;
    for (int i = 0; 2 * i <= n; ++i) part += k_tables.bend[level_][k][i] * folded[i];
    sum += std::abs(part);
  }
  return sum;
}

std::optional<NodePolynomial::Top> NodePolynomial::top_above(double floor, double slack) const {
  const int step = spacing(level_), n = 1 << level_;
  const auto [least, most] = std::minmax_element(values_.begin(), values_.begin() + n + 1);
  if (*most + k_overshoot * (*most - *least) <= floor) return std::nullopt;
  TopSearch search(n, floor, slack);
  search.take(*most, theta(static_cast<int>(most - values_.begin()) * step));
  const double bend = largest_bend();
  // The gaps next to the highest point come first, because their maximum excludes most of the others.
  const int first = std::max(static_cast<int>(most - values_.begin()) - 1, 0);
  for (int k = 0; k < n; ++k) {
    const int gap = (first + k) % n;
    const double from = theta(gap * step), width = theta((gap + 1) * step) - from;
    if (search.is_below(std::max(values_[gap], values_[gap + 1]) + bend * width * width / 8.0)) continue;
    Coefficients b;
    for (int j = 0; j <= n; ++j) {
      b[j] = 0.0;
      for (int i = 0; i <= n; ++i) b[j] += k_tables.bernstein[level_][gap][j][i] * values_[i];
    }
    search.subdivide(b, from, width, k_most_cuts);
  }
  return search.found();
}

} // namespace steplap
