// Times at which a signal begins, reaches its full size, and ends. They decide whether a run covers the whole load.
//
// The course is read from the pieces of the signal, whatever its kind:
//   last piece       example                          course
//   zero             pulse, record, random vibration  it ends where that piece begins
//   its first level  a pulse on top of an offset      the same
//   another level    ramp and hold                    it has no end; full where that piece begins
//   harmonics        sine, sea, road                  it has no end; full where that piece begins, with a mean period
// A signal with an end may be stationary before it, for example a random vibration. Its full size is then the piece consisting of harmonics
// only that has the largest mean square, provided it lasts at least k_periods mean periods. The mean period of Σ a cos(ω t + φ) is 2π √(Σ
// a² / Σ a² ω²), the mean time between two upward zero crossings of a Gaussian process with this spectrum (S. O. Rice, Bell Syst. Tech. J.
// 24 (1945) 46).
#pragma once

#include "mbd/model/signal.h"

#include <limits>

namespace steplap {

/// Times of the course, s; infinite: never.
struct SignalCourse {
  static constexpr double k_periods = 10.0; ///< number of mean periods at full size after which a stationary load counts as fully applied

  double begins = std::numeric_limits<double>::infinity(); ///< before this time the signal is zero, or constant at its first level; ≥ 0
  double full = std::numeric_limits<double>::infinity();   ///< from this time on the signal is a constant level or stationary harmonics
  double ends = std::numeric_limits<double>::infinity();   ///< from this time on the signal is zero, or at its first level
  double period = 0.0;                                     ///< mean period of the harmonics after `full`, s; 0: constant level

  /// Returns true if the signal finally returns to zero or to its first level.
  [[nodiscard]] bool has_end() const { return ends < std::numeric_limits<double>::infinity(); }
  /// Returns true if the signal is constant for all t ≥ 0.
  [[nodiscard]] bool is_level() const { return !(begins < std::numeric_limits<double>::infinity()); }
};

/// Returns the course of the signal from t = 0 on.
[[nodiscard]] SignalCourse course_of(const Signal& signal);

} // namespace steplap
