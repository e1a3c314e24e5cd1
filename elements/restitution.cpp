#include "elements/restitution.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_natural_log_of_ten = 2.302585092994045684;

// −ln e. It grows with ζ: 2ζ·arccos ζ/√(1 − ζ²) goes on over ζ = 1 as 2ζ·arcosh ζ/√(ζ² − 1), with the value 2 between them.
double log_loss(double ratio) {
  const double square = (1.0 - ratio) * (1.0 + ratio), root = std::sqrt(std::abs(square));
  if (root == 0.0) return 2.0;
  const double angle = square > 0.0 ? portable::atan2(root, ratio) : k_natural_log_of_ten * portable::log10(ratio + root);
  return 2.0 * ratio * angle / root;
}

double inverse_mass(int index, const double* j, const SystemBuilder& builder) {
  if (index == k_ground) return 0.0;
  for (const Body& body : builder.model().bodies)
    if (builder.body(body.name) == index && !body.fixed) return (j[0] * j[0] + j[1] * j[1]) / body.mass + j[2] * j[2] / body.inertia;
  return 0.0;
}

} // namespace

double restitution_of(double damping_ratio) { return portable::pow(10.0, -log_loss(damping_ratio) / k_natural_log_of_ten); }

double damping_for_restitution(double restitution, double stiffness, double mass) {
  if (restitution == 1.0) return 0.0;
  const double wanted = -k_natural_log_of_ten * portable::log10(restitution);
  // For large ζ e tends to 1/(4ζ²), from below: so ζ is less than 1/√e.
  double low = 0.0, high = 1.0 / std::sqrt(restitution);
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) break;
    (log_loss(middle) < wanted ? low : high) = middle;
  }
  return 2.0 * high * std::sqrt(stiffness * mass);
}

double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder) {
  const double inverse = inverse_mass(a, gradient.side(0), builder) + inverse_mass(b, gradient.side(1), builder);
  return inverse > 0.0 ? 1.0 / inverse : std::numeric_limits<double>::infinity();
}

} // namespace steplap
