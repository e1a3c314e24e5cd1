#include "elements/restitution.h"

#include "mbd/base/portable_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace steplap {

namespace {

constexpr double k_natural_log_of_ten = 2.302585092994045684;

// Returns −ln e for the damping ratio ζ = `ratio`; it increases with ζ. 2ζ·arccos ζ/√(1 − ζ²) continues for ζ > 1 as 2ζ·arcosh ζ/√(ζ² − 1);
// at ζ = 1 both are 2.
double log_loss(double ratio) {
  const double square = (1.0 - ratio) * (1.0 + ratio), root = std::sqrt(std::abs(square));
  if (root == 0.0) return 2.0;
  const double angle = square > 0.0 ? portable::atan2(root, ratio) : k_natural_log_of_ten * portable::log10(ratio + root);
  return 2.0 * ratio * angle / root;
}

// Number of coordinates of joined bodies above which the effective mass is not computed, because dense algebra would take more than a tenth
// of a second.
constexpr std::size_t k_most_coordinates = 600;
// A row is dependent if its gradient has less than this relative length outside the span of the others.
constexpr double k_dependent = 1e-8;
// J P Jᵀ below this, relative to J M⁻¹ Jᵀ, counts as zero: joints prevent any motion along the gap.
constexpr double k_held = 1e-14;

// Set of bodies that joints and drives connect with given ones, and the rows between them. Connections through the ground do not count.
class JoinedBodies {
public:
  JoinedBodies(const System& system, int a, int b) : system_(system), place_(system.bodies.size(), -1) {
    add(a);
    add(b);
    for (std::size_t known = 0; known < bodies_.size() && coordinates() <= k_most_coordinates;) {
      known = bodies_.size();
      for (const RowSpec& row : system.rows) {
        if (!moves(row)) continue;
        for (const RowSpec* part = &row; part; part = part->next) {
          add(part->a);
          add(part->b);
        }
      }
    }
  }
  /// Returns true if the row acts on one of the bodies.
  [[nodiscard]] bool moves(const RowSpec& row) const {
    for (const RowSpec* part = &row; part; part = part->next)
      if (is_in(part->a) || is_in(part->b)) return true;
    return false;
  }
  [[nodiscard]] std::size_t coordinates() const { return 3 * bodies_.size(); }
  /// Adds M^(−1/2) Jᵀ of a row, or of one part of it, between bodies a and b.
  void add_weighed(const RowGradient<double>& gradient, int a, int b, VecX& result) const {
    for (int i = 0; i < 6; ++i) {
      const int body = i < 3 ? a : b;
      if (body == k_ground) continue;
      const BodyData& data = system_.bodies[static_cast<std::size_t>(body)];
      result[3 * place_[static_cast<std::size_t>(body)] + i % 3] += gradient.j[i] / std::sqrt(i % 3 < 2 ? data.mass : data.inertia);
    }
  }

private:
  [[nodiscard]] bool is_in(int body) const { return body != k_ground && place_[static_cast<std::size_t>(body)] >= 0; }
  void add(int body) {
    if (body == k_ground || is_in(body)) return;
    place_[static_cast<std::size_t>(body)] = static_cast<int>(bodies_.size());
    bodies_.push_back(body);
  }
  const System& system_;
  std::vector<int> place_, bodies_;
};

double inverse_mass(int index, const double* j, const System& system) {
  if (index == k_ground) return 0.0;
  const BodyData& body = system.bodies[static_cast<std::size_t>(index)];
  return (j[0] * j[0] + j[1] * j[1]) / body.mass + j[2] * j[2] / body.inertia;
}

// Subtracts from v its component in the span of an orthonormal basis. The second pass removes the rounding errors of the first.
void remove_span(const std::vector<VecX>& basis, VecX& v) {
  for (int pass = 0; pass < 2; ++pass)
    for (const VecX& q : basis) v -= q.dot(v) * q;
}

} // namespace

double restitution_of(double damping_ratio) { return portable::pow(10.0, -log_loss(damping_ratio) / k_natural_log_of_ten); }

double damping_for_restitution(double restitution, double stiffness, double mass) {
  if (restitution == 1.0) return 0.0;
  const double wanted = -k_natural_log_of_ten * portable::log10(restitution);
  // Upper bound of ζ: for large ζ, e approaches 1/(4ζ²) from below, so ζ < 1/√e.
  double low = 0.0, high = 1.0 / std::sqrt(restitution);
  while (true) {
    const double middle = 0.5 * (low + high);
    if (!(low < middle && middle < high)) break;
    (log_loss(middle) < wanted ? low : high) = middle;
  }
  return 2.0 * high * std::sqrt(stiffness * mass);
}

double effective_mass(const RowGradient<double>& gradient, int a, int b, const SystemBuilder& builder) {
  const System& system = builder.compiled();
  const JoinedBodies joined(system, a, b);
  if (joined.coordinates() > k_most_coordinates) return std::numeric_limits<double>::quiet_NaN();
  const VecX none = VecX::Zero(static_cast<Eigen::Index>(joined.coordinates()));
  std::vector<VecX> held;
  for (const RowSpec& row : system.rows) {
    if (!joined.moves(row)) continue;
    VecX v = none;
    for (const RowSpec* part = &row; part; part = part->next)
      joined.add_weighed(row_gradient(*part, builder.reference(part->a), builder.reference(part->b)), part->a, part->b, v);
    const double size = v.norm();
    remove_span(held, v);
    if (v.norm() > k_dependent * size) held.push_back(v / v.norm());
  }
  const double free = inverse_mass(a, gradient.side(0), system) + inverse_mass(b, gradient.side(1), system);
  double inverse = free;
  if (!held.empty()) {
    VecX gap = none;
    joined.add_weighed(gradient, a, b, gap);
    remove_span(held, gap);
    inverse = gap.squaredNorm();
  }
  return inverse > k_held * free ? 1.0 / inverse : std::numeric_limits<double>::infinity();
}

} // namespace steplap
