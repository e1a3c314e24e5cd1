// A point that rests or slides on a rough plane: one contact of a machine, pulled in two directions at once.
//
//   m v' = D(t) - F,  |F| <= mu_s N(t) while it rests (F = D),  F = mu_k N(t) v/|v| while it slides
//
// D and N are linear between the instants at which they are given. The onset of sliding is the root of |D|² = (mu_s N)², a quadratic.
// Sliding is integrated by a diagonally implicit Runge-Kutta method of order 3 (Alexander 1977, L-stable, three stages). Each of its
// stages is an implicit Euler step, solved exactly: with r = γ h mu_k N / m, the velocity w + γ h D / m is shortened by r, or is zero if
// it is shorter than r. That is regular at v = 0, where the direction of F is not. The end of sliding follows from the closed form
// for a constant load with c = mu_k N / m > d = |D| / m, x along D, s = |v|:
//
//   c s + d v_x falls at the rate c² - d²:  the point stops after T = (c s + d v_x) / (c² - d²)
//   ∫ v_x dt = (c s v_x + d (v_x² + s²) / 2) / (2 (c² - d²)),  ∫ v_y dt = (2 c s v_y + d v_x v_y) / (4 c² - d²)
//   ∫ s dt = (2 d ∫ v_x dt + s²) / (2 c)
//
// The first line is d(v_x)/dt = d - c v_x/s and ds/dt = d v_x/s - c, added; the others follow from the rates of s v_x, v_x², s²,
// s v_y and v_x v_y.
#pragma once

#include "mbd/base/types.h"

#include <optional>

namespace steplap::assess {

/// Pulls and presses on the point.
struct PointLoad {
  Vec2 drive = Vec2::Zero(); ///< N, all forces in the plane but friction
  double normal = 0.0;       ///< N, never negative
};

class SlidingPoint {
public:
  /// `mass` > 0, `mu_kinetic` <= `mu_static`. `largest_step` of the integration, s. A velocity other than zero slides from the start.
  SlidingPoint(double mass, double mu_static, double mu_kinetic, double largest_step = 1e-4, const Vec2& velocity = Vec2::Zero());

  /// Moves on for `duration`, in which the load goes straight from `begin` to `end`.
  void advance(const PointLoad& begin, const PointLoad& end, double duration);
  /// Moves on under a constant load until it rests. Returns false, and leaves it where it is, if that load lets it slide on for ever.
  [[nodiscard]] bool come_to_rest(const PointLoad& load);

  [[nodiscard]] double time() const { return time_; }
  [[nodiscard]] const Vec2& position() const { return position_; }
  [[nodiscard]] const Vec2& velocity() const { return velocity_; }
  [[nodiscard]] double path() const { return path_; } ///< m, length of the way it has slid
  [[nodiscard]] bool rests() const { return rests_; }
  [[nodiscard]] std::optional<double> first_slip() const { return first_slip_; } ///< s
  [[nodiscard]] std::optional<double> last_rest() const { return last_rest_; }   ///< s, when it last came to rest

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
