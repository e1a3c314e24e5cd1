// Finds the first event inside a step: where a watch value falls below zero.
//
// Looked at: the step's end, the stages inside it (free of charge), and, where a value's rate is known
// at both ends and it dips in between, the bottom of its cubic; if that may be below zero, the dip is followed
// on dense output, cubic by cubic, down to its bottom. Where nothing moves no error limits an adaptive step, and
// loads may rise and fall within it: it is looked at many times in each of their periods. Whatever raises suspicion is scanned on
// dense output, then the root is closed in on to rounding; all values that are negative on the far side
// of the bracket fire together.
//
// A value that belongs to a unit or friction whose mode has just changed is *fresh*: it starts at zero
// up to rounding and is not believed negative until it has been positive.
#pragma once

#include "mbd/integrators/integrator.h"

#include <vector>

namespace steplap {

class EventFinder {
public:
  EventFinder(const System& system, int max_dimension);

  /// True if the step just made by `integrator` contains an event; then theta(), state() and fired()
  /// tell which. `fresh[slot]` as above.
  bool find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);

  [[nodiscard]] double theta() const { return theta_; }
  [[nodiscard]] const std::vector<double>& state() const { return y_; }
  [[nodiscard]] const std::vector<int>& fired() const { return fired_; }

private:
  enum class Suspicion { none, at_end, inside };
  enum class Bracket { none, found, at_once };
  [[nodiscard]] Suspicion suspicion(const Integrator& integrator, const std::vector<char>& fresh);
  Bracket scan(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);
  Bracket bracket_whole(const Integrator& integrator);
  void close_in(Integrator& integrator, Dynamics& dynamics);
  void follow_dip(Integrator& integrator, Dynamics& dynamics, int slot);
  void watch_rest(Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool is_negative_near(Integrator& integrator, Dynamics& dynamics, int slot, double middle, double reach);
  void watch_at(Integrator& integrator, Dynamics& dynamics, double theta, std::vector<double>& watch);
  [[nodiscard]] bool crosses(const std::vector<double>& low, const std::vector<double>& high);

  [[nodiscard]] bool starts_negative(const Integrator& integrator, int slot) const;

  double shortest_period_; ///< of the loads, s
  int slots_;
  int unit_slots_; ///< those of contacts and springs come first
  bool is_resting_ = false; ///< nothing moves in the step: joints far from their limits are looked at, too
  double theta_ = 0.0;
  double theta_low_ = 0.0, theta_high_ = 1.0;
  std::vector<double> y_, dy_, low_, high_, middle_;
  std::vector<double> look_at_;  ///< places inside the step to scan besides the even ones
  std::vector<int> dips_;        ///< slots whose bottom inside the step may be below zero
  std::vector<char> armed_;      ///< believed when negative
  std::vector<int> fired_;
};

} // namespace steplap
