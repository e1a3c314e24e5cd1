#include "elements/machinery/road.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_most_tries = 100;
constexpr double k_settled = 4.0 * std::numeric_limits<double>::epsilon(); // convergence of positions, relative

} // namespace

// Finds the first sign change, downhill from s = x, of f = (s − x) + h′ (h − y), half the derivative of the squared distance. In hollows
// the steps −f/(1 + h′²) are too short, so none passes the root; on crests they may be too long, and then they bracket it.
double Road::nearest_x(double x, double y) const {
  const auto slope_at = [&](double s, CurveJet<double>& jet) {
    jet = curve_.jet(s);
    return (s - x) + jet.slope * (jet.value - y);
  };
  CurveJet<double> jet;
  double here = x, f = slope_at(here, jet), other = x;
  bool is_enclosed = false;
  for (int i = 0; i < k_most_tries && f != 0.0; ++i) {
    const double pull = pull_of(jet, y), careful = 1.0 + jet.slope * jet.slope;
    double next = here - f / (is_enclosed && pull > 0.0 ? pull : careful);
    if (is_enclosed && !((next - here) * (next - other) < 0.0)) next = 0.5 * (here + other);
    if (std::abs(next - here) <= k_settled * (std::abs(x) + std::abs(y) + std::abs(next))) return next;
    const double before = here, f_before = f;
    here = next;
    f = slope_at(here, jet);
    if (f * f_before < 0.0) {
      other = before;
      is_enclosed = true;
    }
  }
  return here;
}

// Solves x = z − r sin φ(z) for the contact position z; x is monotonic in z, x′ = 1 − r κ > 0. Newton's method, with bisection where an
// iterate leaves the bracket of z.
double Road::touched_below(double x, double radius, double near) const {
  double low = x - radius, high = x + radius, here = std::clamp(near, low, high); // because |z − x| ≤ r
  for (int i = 0; i < k_most_tries; ++i) {
    const CurveJet<double> jet = curve_.jet(here);
    const double grown = std::sqrt(1.0 + jet.slope * jet.slope);
    const double off = here - radius * jet.slope / grown - x;
    (off > 0.0 ? high : low) = here;
    double next = here - off / (1.0 - radius * jet.curvature / (grown * grown * grown));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (std::abs(next - here) <= k_settled * (std::abs(x) + radius)) return next;
    here = next;
  }
  return here;
}

void Road::find_pieces() {
  const std::vector<Vec2>& points = curve_.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CurveJet<double> left = curve_.jet(points[i].x());
    Piece piece{left.slope, left.curvature};
    if (i + 1 < points.size())
      piece.third = 0.5 * (curve_.jet(points[i + 1].x()).curvature - left.curvature) / (points[i + 1].x() - points[i].x());
    if (i > 0) piece.length = pieces_.back().length + pieces_.back().length_over(points[i].x() - points[i - 1].x());
    pieces_.push_back(piece);
  }
  pieces_.back().bend = 0.0; // zero curvature at the end, exactly
}

double Road::length_to(double x) const {
  const std::vector<Vec2>& points = curve_.points();
  const Piece& first = pieces_.front();
  if (x <= points.front().x()) return (x - points.front().x()) * std::sqrt(1.0 + first.slope * first.slope);
  const auto after = std::upper_bound(points.begin(), points.end(), x, [](double value, const Vec2& p) { return value < p.x(); });
  const auto i = static_cast<std::size_t>(after - points.begin()) - 1;
  return pieces_[i].length + pieces_[i].length_over(x - points[i].x());
}

// Gauss quadrature of √(1 + y′²) with ten nodes; the slope y′ is a quadratic function.
double Road::Piece::length_over(double d) const {
  constexpr std::array<double, 5> k_node = {0.14887433898163122, 0.43339539412924719, 0.67940956829902441, 0.86506336668898451,
                                            0.97390652851717172};
  constexpr std::array<double, 5> k_weight = {0.29552422471475287, 0.26926671930999636, 0.21908636251598204, 0.14945134915058059,
                                              0.066671344308688138};
  const auto grown = [this](double at) {
    const double y = slope + at * (bend + at * third);
    return std::sqrt(1.0 + y * y);
  };
  const double half = 0.5 * d;
  double sum = 0.0;
  for (std::size_t k = 0; k < k_node.size(); ++k) sum += k_weight[k] * (grown(half - k_node[k] * half) + grown(half + k_node[k] * half));
  return half * sum;
}

// Finds the largest upward curvature κ = h″/(1 + h′²)^{3/2} of the road. h″ is linear between the points, but κ has no simple maximum
// because of h′, and is therefore sampled.
void Road::find_hollowest() {
  constexpr int k_samples = 16;
  const std::vector<Vec2>& points = curve_.points();
  for (std::size_t i = 1; i < points.size(); ++i)
    for (int k = 0; k <= k_samples; ++k) {
      const double x = points[i - 1].x() + (points[i].x() - points[i - 1].x()) * k / k_samples;
      const CurveJet<double> jet = curve_.jet(x);
      const double grown = std::sqrt(1.0 + jet.slope * jet.slope), curvature = jet.curvature / (grown * grown * grown);
      if (!(curvature > hollowest_)) continue;
      hollowest_ = curvature;
      hollowest_at_ = x;
    }
}

} // namespace steplap
