#include "elements/road.h"

#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr int k_most_tries = 100;
constexpr double k_settled = 4.0 * std::numeric_limits<double>::epsilon(); // of places: rounding

} // namespace

// Where ½ d/dx of the squared distance, f = (s − x) + h′ (h − y), changes its sign first, downhill from s = x. In hollows steps of
// −f/(1 + h′²) are too short, so that none passes over the place; on crests they may be too long, and then enclose it.
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

// h″ is straight between the points. What the slope takes from it is found by samples.
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
