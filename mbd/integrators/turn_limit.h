// Limit of the relative rotation of pairs of bodies within one step (mbd/system/turn_table.h).
//
// Before a step its length is limited by the relative angular velocities at its start, and by angular accelerations that increase them.
// After the step the angles at both ends are compared. A step that rotated too far is repeated with a shorter length.
#pragma once

#include "mbd/dynamics/layout.h"
#include "mbd/system/turn_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

/// Limits of rotation for the bodies of one system, which must outlive this object.
class TurnLimit {
public:
  /// Largest rotation of a pair in one step, rad.
  static constexpr double k_most = 1.0;

  explicit TurnLimit(const System& system);

  /// Returns the longest step, s, at most `h`, that keeps the limit according to the rates at its start. `y` and `dy`: packed state and
  /// its rate. With `division` > 1 (finer run) the limit and the intervals between knots are divided by it.
  [[nodiscard]] double longest(const Layout& layout, const double* y, const double* dy, double h, int division) {
    limiting_ = nullptr;
    if (is_free(2.0 * division * h * fastest(layout, y + layout.coordinate_count), k_aim)) return h;
    return shortened(layout, y, dy, h, division);
  }
  /// Returns the fraction of the step from y0 to y1 that keeps the limit; 1 for the whole step.
  [[nodiscard]] double kept(const Layout& layout, const double* y0, const double* y1) {
    limiting_ = nullptr;
    return is_free(2.0 * furthest(layout, y0, y1), k_most) ? 1.0 : kept_by_all(layout, y0, y1);
  }
  /// Returns the pair that limited the last step; null: none.
  [[nodiscard]] const Turn* limiting() const { return limiting_; }

private:
  /// Planned rotation, below the limit, so that accelerations rarely make a step exceed it.
  static constexpr double k_aim = 0.95 * k_most;

  /// Returns true if single pairs need not be checked, because no rotation is large enough.
  [[nodiscard]] bool is_free(double twice_turned, double most) const { return !has_knots_ && (turns_.empty() || twice_turned <= most); }
  /// Calls f with the index of each coordinate that is an angle.
  template <class F> static void for_angles(const Layout& layout, const F& f) {
    for (int k = 0; k < layout.absolute_count; ++k) f(3 * k + 2);
    for (const Mechanism& m : layout.mechanisms)
      for (int i = 0; i < m.size(); ++i)
        if (!m.is_place(i)) f(m.first_coordinate + i);
  }
  [[nodiscard]] static double fastest(const Layout& layout, const double* rates) {
    double most = 0.0;
    for_angles(layout, [&](int i) { most = std::max(most, std::abs(rates[i])); });
    return most;
  }
  [[nodiscard]] static double furthest(const Layout& layout, const double* y0, const double* y1) {
    double most = 0.0;
    for_angles(layout, [&](int i) { most = std::max(most, std::abs(y1[i] - y0[i])); });
    return most;
  }
  /// Returns the angle of body a relative to b, rad, or its rate, rad/s. `values`: coordinates or their rates.
  [[nodiscard]] static double relative_turn(const Layout& layout, const Turn& turn, const double* values);
  /// Returns the difference between the relative angle of the two bodies and that of their clusters, rad.
  [[nodiscard]] static double offset(const Layout& layout, const Turn& turn);
  [[nodiscard]] double shortened(const Layout& layout, const double* y, const double* dy, double h, int division);
  [[nodiscard]] static double shortened_by(const Turn& turn, const Layout& layout, const double* y, const double* dy, double h,
                                           int division);
  [[nodiscard]] double kept_by_all(const Layout& layout, const double* y0, const double* y1);
  [[nodiscard]] static double kept_by(const Turn& turn, const Layout& layout, const double* y0, double turned);

  std::vector<Turn> turns_;
  bool has_knots_ = false;
  const Turn* limiting_ = nullptr;
};

} // namespace steplap
