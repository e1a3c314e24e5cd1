#include "elements/step_lap/patch/required_pressure.h"

#include "elements/step_lap/patch/gauge.h"
#include "mbd/base/portable_math.h"

#include <cmath>
#include <limits>

namespace steplap {

namespace {

// Wrenches below this fraction of the capacity count as zero: their square underflows, so they have no direction.
constexpr double k_nothing = 1e-150;

} // namespace

std::optional<Vec2> centre_of_rotation(const Vec2& reference, const Vec3& nu) {
  constexpr double infinite = 1e12; // [m]: a centre farther away counts as translation
  if (portable::hypot(nu[0], nu[1]) >= infinite * std::abs(nu[2])) return std::nullopt;
  return reference + Vec2(-nu[1], nu[0]) / nu[2];
}

RequiredPressure required_pressure(const Patch& patch, const Vec3& wrench, const Vec3& warm, double tolerance) {
  RequiredPressure out;
  if (wrench.isZero(0)) return out;
  if (patch.empty()) {
    out.u = std::numeric_limits<double>::infinity();
    return out;
  }
  const ScaledPatch scaled(patch);
  const Vec3 all = scaled.scaled_wrench(wrench);
  if (all.cwiseAbs().maxCoeff() < k_nothing) return out; // such a wrench is the remainder of a decaying motion
  const double size = all.norm();
  const Vec3 w = all / size;

  const Gauge g = find_gauge(scaled, w, warm.isZero(0) ? warm : scaled.scaled_twist(warm), tolerance);
  out.u = size * g.value;
  out.evaluations = g.evaluations;
  out.residual = g.residual;
  out.converged = g.converged;
  out.direction = scaled.twist(g.y.normalized());
  out.centre = centre_of_rotation(patch.reference(), out.direction);
  return out;
}

Capacity capacity(const Patch& patch) {
  Capacity out;
  if (patch.empty()) return out;
  out.arm = patch.centroid() - patch.reference();
  out.force = patch.force();
  out.polar = patch.force() * patch.gyration();
  // A moment is the same about every point. The gradient at the solution is in the admissible set, so 1/u has an error of the order of the
  // squared tolerance; the factor 1 − 1e-9 covers this and all rounding, so that the couple is a lower bound.
  out.couple = (1 - 1e-9) / required_pressure(patch, {0, 0, 1}).u;
  return out;
}

UsageBounds usage_bounds(const Capacity& c, const Vec3& wrench) {
  const double force = std::sqrt(wrench[0] * wrench[0] + wrench[1] * wrench[1]);
  const double couple = std::abs(wrench[2] - (c.arm.x() * wrench[1] - c.arm.y() * wrench[0]));
  if (force == 0 && couple == 0) return {};
  if (!(c.force > 0)) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    return {infinite, infinite};
  }
  const double f = force / c.force, m = couple / c.polar;
  return {std::sqrt(f * f + m * m), f + couple / c.couple};
}

} // namespace steplap
