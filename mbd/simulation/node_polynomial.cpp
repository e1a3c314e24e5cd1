#include "mbd/simulation/node_polynomial.h"

#include "mbd/math/portable_math.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap {

namespace {

constexpr int k_points = NodePolynomial::k_last + 1;
// By how much a polynomial may exceed its values at the points, of their spread: half of what Lebesgue's constant is above one.
// That is 1.25, 1.7988 and 2.2748 for the three levels.
constexpr double k_overshoot = 0.6375;
// Halvings of a gap between points: of a quadratic top the coefficients are then off by 4^-24 of what they differ by.
constexpr int k_most_halvings = 24;
constexpr double k_about = 1e-3; // of the interval: the top's last digits by a parabola about it

double node_theta(int node) { return 0.5 * (1.0 - portable::cos(std::numbers::pi * node / NodePolynomial::k_last)); }

using Coefficients = std::array<double, k_points>;

// Made before main(): threads that run side by side find it made.
struct Tables {
  std::array<double, k_points> theta{};
  /// Of level l, in the gap behind point j: what value i adds to coefficient k.
  double bernstein[NodePolynomial::k_levels + 1][NodePolynomial::k_last][k_points][k_points] = {};

  Tables() {
    for (int i = 0; i < k_points; ++i) theta[i] = node_theta(i);
    for (int level = 1; level <= NodePolynomial::k_levels; ++level)
      for (int gap = 0; gap < 1 << level; ++gap)
        for (int i = 0; i <= 1 << level; ++i) set(level, gap, i);
  }

  // Lagrange's polynomial of point i is a product of factors that are linear in the gap: each raises the degree by one.
  void set(int level, int gap, int i) {
    const int step = NodePolynomial::spacing(level), n = 1 << level;
    const double from = theta[gap * step], to = theta[(gap + 1) * step];
    Coefficients b{1.0};
    int degree = 0;
    for (int k = 0; k <= n; ++k) {
      if (k == i) continue;
      const double scale = 1.0 / (theta[i * step] - theta[k * step]);
      const double low = (from - theta[k * step]) * scale, high = (to - theta[k * step]) * scale;
      ++degree;
      for (int j = degree; j >= 0; --j)
        b[j] = ((degree - j) * low * (j < degree ? b[j] : 0.0) + j * high * (j > 0 ? b[j - 1] : 0.0)) / degree;
    }
    for (int k = 0; k <= n; ++k) bernstein[level][gap][k][i] = b[k];
  }
};

const Tables k_tables;

// Looks for the top in a gap, or a part of one.
class TopSearch {
public:
  TopSearch(int degree, double floor, double slack) : degree_(degree), best_(floor), slack_(slack) {}

  // The part from `from` on, `width` wide.
  void look(const Coefficients& b, double from, double width, int halvings) {
    take(b[0], from);
    take(b[degree_], from + width);
    if (!(*std::max_element(b.begin(), b.begin() + degree_ + 1) > best_ + slack_) || halvings == 0) return;
    Coefficients left = b, right = b;
    for (int k = 1; k <= degree_; ++k)
      for (int j = degree_; j >= k; --j) left[j] = 0.5 * (left[j - 1] + left[j]);
    for (int k = 1; k <= degree_; ++k)
      for (int j = 0; j <= degree_ - k; ++j) right[j] = 0.5 * (right[j] + right[j + 1]);
    const double half = 0.5 * width;
    const bool is_right_first = right[degree_] > left[0];
    if (is_right_first) look(right, from + half, half, halvings - 1);
    look(left, from, half, halvings - 1);
    if (!is_right_first) look(right, from + half, half, halvings - 1);
  }

  void take(double value, double theta) {
    if (!(value > best_)) return;
    best_ = value;
    found_ = {value, theta};
  }

  [[nodiscard]] const std::optional<NodePolynomial::Top>& found() const { return found_; }

private:
  int degree_;
  double best_, slack_;
  std::optional<NodePolynomial::Top> found_;
};

} // namespace

double NodePolynomial::theta(int node) { return k_tables.theta[node]; }

// Barycentric.
double NodePolynomial::at(double theta) const {
  const int step = spacing(level_), n = 1 << level_;
  double above = 0.0, below = 0.0, sign = 1.0;
  for (int i = 0; i <= n; ++i) {
    const double distance = theta - k_tables.theta[i * step];
    if (distance == 0.0) return values_[i];
    const double weight = (i == 0 || i == n ? 0.5 : 1.0) * sign / distance;
    above += weight * values_[i];
    below += weight;
    sign = -sign;
  }
  return above / below;
}

std::optional<NodePolynomial::Top> NodePolynomial::top_above(double floor, double slack) const {
  const int step = spacing(level_), n = 1 << level_;
  const auto [least, most] = std::minmax_element(values_.begin(), values_.begin() + n + 1);
  if (*most + k_overshoot * (*most - *least) <= floor) return std::nullopt;
  TopSearch search(n, floor, slack);
  for (int i = 0; i <= n; ++i) search.take(values_[i], k_tables.theta[i * step]);
  // The gaps beside the highest point first, for what they have rules out most of the others.
  const int peak = static_cast<int>(most - values_.begin());
  for (int k = 0; k < n; ++k) {
    const int gap = (std::max(peak - 1, 0) + k) % n;
    Coefficients b;
    for (int j = 0; j <= n; ++j) {
      b[j] = 0.0;
      for (int i = 0; i <= n; ++i) b[j] += k_tables.bernstein[level_][gap][j][i] * values_[i];
    }
    search.look(b, k_tables.theta[gap * step], k_tables.theta[(gap + 1) * step] - k_tables.theta[gap * step], k_most_halvings);
  }
  if (!search.found()) return std::nullopt;
  const double x = std::clamp(search.found()->theta, k_about, 1.0 - k_about);
  const Top vertex = vertex_about(x);
  return vertex.value > search.found()->value ? vertex : search.found();
}

NodePolynomial::Top NodePolynomial::vertex_about(double theta) const {
  const double a = at(theta - k_about), b = at(theta), c = at(theta + k_about);
  const double slope = 0.5 * (c - a), bend = a - 2.0 * b + c;
  if (!(std::abs(bend) > 0.0)) return {b, theta};
  const double shift = std::clamp(-slope / bend, -1.0, 1.0);
  return {b + shift * (slope + 0.5 * bend * shift), theta + shift * k_about};
}

} // namespace steplap
