// A patch in scaled units, for the convex problems: twists about the centroid of the traction with ω in units of 1/gyration, h and wrenches
// in units of the force capacity. Then h(y) ≤ |y|, with equality for translation, whatever the size, position and pressure of the patch.
#pragma once

#include "elements/step_lap/patch/limit_surface.h"

namespace steplap {

/// A patch with conversions of twists and wrenches between SI and scaled units. The patch must outlive this object.
class ScaledPatch {
public:
  /// Precondition: the patch is not empty.
  explicit ScaledPatch(const Patch& patch) : patch_(patch), centre_(patch.centroid()), force_(patch.force()), size_(patch.gyration()) {
    const Vec2 arm = centre_ - patch.reference();
    // y = S ν: the first two components are the velocity v + ω ẑ×arm of the centroid, the third is size·ω
    to_scaled_ << 1, 0, -arm.y(), 0, 1, arm.x(), 0, 0, size_;
    from_scaled_ << 1, 0, arm.y() / size_, 0, 1, -arm.x() / size_, 0, 0, 1 / size_;
  }

  [[nodiscard]] double force() const { return force_; }
  [[nodiscard]] Vec3 scaled_twist(const Vec3& nu) const { return to_scaled_ * nu; }
  [[nodiscard]] Vec3 twist(const Vec3& y) const { return from_scaled_ * y; }
  [[nodiscard]] Vec3 scaled_wrench(const Vec3& w) const { return from_scaled_.transpose() * w / force_; }
  [[nodiscard]] Vec3 wrench(const Vec3& w) const { return to_scaled_.transpose() * w * force_; }
  /// Converts a matrix that maps wrenches to twists.
  [[nodiscard]] Mat3 scaled_mobility(const Mat3& a) const { return to_scaled_ * a * to_scaled_.transpose() * force_; }

  [[nodiscard]] Dissipation evaluate(const Vec3& y) const {
    Dissipation d = evaluate_about(patch_, centre_, {y[0], y[1], y[2] / size_});
    scale_gradient(d);
    const double f = 1 / force_, s = 1 / size_;
    d.hessian *= f;
    d.hessian.row(2) *= s;
    d.hessian.col(2) *= s;
    return d;
  }
  /// Returns h and its gradient; the Hessian is zero.
  [[nodiscard]] Dissipation evaluate_gradient(const Vec3& y) const {
    Dissipation d = evaluate_gradient_about(patch_, centre_, {y[0], y[1], y[2] / size_});
    scale_gradient(d);
    return d;
  }

private:
  void scale_gradient(Dissipation& d) const {
    const double f = 1 / force_, s = 1 / size_;
    d.h *= f;
    d.gradient *= f;
    d.gradient[2] *= s;
  }

  const Patch& patch_;
  Vec2 centre_;
  double force_, size_;
  Mat3 to_scaled_, from_scaled_;
};

} // namespace steplap
