// When a signal begins, is at its full size, and ends: what tells whether a run has seen all of it.
//
// The course is read from the pieces of the signal, whatever its kind:
//   last piece       example                          course
//   zero             pulse, record, random vibration  it ends where that piece begins
//   its first level  a pulse on top of an offset      the same
//   another level    ramp and hold                    it has no end; full where that piece begins
//   harmonics        sine, sea, road                  it has no end; full where that piece begins, with a mean period
// A signal with an end may be stationary before it, as a random vibration is: the piece of harmonics alone with the largest mean
// square is then its full size, if it is k_periods mean periods long or longer. The mean period of Σ a cos(ω t + φ) is 2π √(Σ a² / Σ a² ω²), the mean time between two
// upward crossings of a Gaussian process with this spectrum (S. O. Rice, Bell Syst. Tech. J. 24 (1945) 46).
#pragma once

#include "mbd/model/signal.h"

#include <limits>

namespace steplap {

/// Times are in s; infinite: never.
struct SignalCourse {
  static constexpr double k_periods = 10.0; ///< at full size, after which a load that goes on alike has acted

  double begins = std::numeric_limits<double>::infinity(); ///< before it the signal is zero, or at its first level; not before t = 0
  double full = std::numeric_limits<double>::infinity();   ///< from there on it is a level, or harmonics
  double ends = std::numeric_limits<double>::infinity();   ///< from there on it is zero, or at its first level
  double period = 0.0;                                     ///< mean period of the harmonics from `full` on; 0: a level

  /// Does it return to zero, or to its first level, for good?
  [[nodiscard]] bool has_end() const { return ends < std::numeric_limits<double>::infinity(); }
  /// It never differs from zero, or from one level.
  [[nodiscard]] bool is_level() const { return !(begins < std::numeric_limits<double>::infinity()); }
};

/// Returns the course of the signal from t = 0 on.
[[nodiscard]] SignalCourse course_of(const Signal& signal);

} // namespace steplap
