// How far pairs of bodies may turn against each other within one step (mbd/system/turn_table.h).
//
// Before a step its length is limited by the relative angular velocities at its begin, and by angular accelerations where these make a
// rotation faster; after it the angles at its ends tell whether the bound was kept. A step that turned further is made again, shorter.
#pragma once

#include "mbd/dynamics/layout.h"
#include "mbd/system/turn_table.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace steplap {

class TurnLimit {
public:
  /// No step turns a pair further than this, rad.
  static constexpr double k_most = 1.0;

  explicit TurnLimit(const System& system);

  /// The longest step that is not longer than `h` and, as far as rates tell, keeps the bound. `y`, `dy`: packed state and its rate. Of a
  /// finer run, `division` above 1, the bound and intervals between knots are divided.
  [[nodiscard]] double longest(const Layout& layout, const double* y, const double* dy, double h, int division) {
    limiting_ = nullptr;
    if (is_free(2.0 * division * h * fastest(layout, y + layout.coordinate_count), k_aim)) return h;
    return shortened(layout, y, dy, h, division);
  }
  /// The share of the step from y0 to y1 that keeps the bound; 1: all of it.
  [[nodiscard]] double kept(const Layout& layout, const double* y0, const double* y1) {
    limiting_ = nullptr;
    return is_free(2.0 * furthest(layout, y0, y1), k_most) ? 1.0 : kept_by_all(layout, y0, y1);
  }
  /// The pair for which the step last asked for is shorter; null: none.
  [[nodiscard]] const Turn* limiting() const { return limiting_; }

private:
  /// Aimed at, so that what accelerations change in a step seldom makes it a step too long.
  static constexpr double k_aim = 0.95 * k_most;

  /// Nothing turns far enough to be looked at pair by pair.
  [[nodiscard]] bool is_free(double twice_turned, double most) const { return !has_knots_ && (turns_.empty() || twice_turned <= most); }
  /// Calls f with each coordinate that is an angle.
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
  /// Returns the angle of the pair's a against its b, as `values` has it of coordinates.
  [[nodiscard]] static double difference(const Layout& layout, const Turn& turn, const double* values);
  /// From a curve's argument to the angle between coordinates of the layout: clusters carry the angle of one of their bodies.
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
