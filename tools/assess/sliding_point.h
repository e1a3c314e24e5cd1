// Dynamics of a point mass on a rough plane, which sticks or slides under a force in two directions:
//
//   m v' = D(t) - F,  |F| <= mu_s N(t) at rest (F = D),  F = mu_k N(t) v/|v| while sliding
//
// D and N are linear between given times. Sliding begins at the root of |D|² = (mu_s N)², a quadratic equation. It is integrated by a
// diagonally implicit Runge-Kutta method of order 3 (Alexander 1977, L-stable, three stages). Each stage is an implicit Euler step, solved
// exactly: with r = γ h mu_k N / m, the vector w + γ h D / m is shortened by r, or is zero if it is shorter than r. This is regular at v =
// 0, where the direction of F is undefined. The end of sliding follows from the exact solution for constant load, with c = mu_k N / m > d =
// |D| / m, x along D, s = |v|:
//
//   c s + d v_x decreases at the rate c² - d²:  the point stops after T = (c s + d v_x) / (c² - d²)
//   ∫ v_x dt = (c s v_x + d (v_x² + s²) / 2) / (2 (c² - d²)),  ∫ v_y dt = (2 c s v_y + d v_x v_y) / (4 c² - d²)
//   ∫ s dt = (2 d ∫ v_x dt + s²) / (2 c)
//
// Proof: dv_x/dt = d - c v_x/s and ds/dt = d v_x/s - c give the first line; the others follow from the derivatives of s v_x, v_x², s², s
// v_y and v_x v_y.
#pragma once

#include "mbd/base/types.h"

#include <optional>

namespace steplap::assess {

/// Forces on the point.
struct PointLoad {
  Vec2 drive = Vec2::Zero(); ///< sum of all forces in the plane except friction, N
  double normal = 0.0;       ///< normal force, N, ≥ 0
};

/// A point mass on a rough plane, at rest or sliding.
class SlidingPoint {
public:
  /// Preconditions: `mass` > 0 kg, `mu_kinetic` ≤ `mu_static`. `largest_step` limits the integration steps, s. With a non-zero `velocity`,
  /// m/s, the point slides from the start.
  SlidingPoint(double mass, double mu_static, double mu_kinetic, double largest_step = 1e-4, const Vec2& velocity = Vec2::Zero());

  /// Advances by `duration`, s, while the load changes linearly from `begin` to `end`.
  void advance(const PointLoad& begin, const PointLoad& end, double duration);
  /// Advances under a constant load until the point stops. Returns false, without a change, if the load exceeds the friction, so that it
  /// never stops.
  [[nodiscard]] bool come_to_rest(const PointLoad& load);

  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] const Vec2& position() const { return position_; }
  [[nodiscard]] const Vec2& velocity() const { return velocity_; }
  [[nodiscard]] double path() const { return path_; } ///< length of the path, m
  [[nodiscard]] bool rests() const { return rests_; }
  [[nodiscard]] std::optional<double> first_slip() const { return first_slip_; } ///< time of the first onset of sliding, s
  [[nodiscard]] std::optional<double> last_rest() const { return last_rest_; }   ///< time at which the point last came to rest, s

private:
  struct Piece;
  [[nodiscard]] double onset(const Piece& piece, double from) const;
  [[nodiscard]] std::optional<double> time_to_stop(const PointLoad& load) const;
  [[nodiscard]] double step_for(const PointLoad& load) const;
  void stop(const PointLoad& load, double after);
  void step(const Piece& piece, double from, double h);

  double mass_, mu_static_, mu_kinetic_, largest_step_;
  double time_ = 0.0, path_ = 0.0;
  Vec2 position_ = Vec2::Zero(), velocity_;
  bool rests_;
  std::optional<double> first_slip_, last_rest_;
};

} // namespace steplap::assess
