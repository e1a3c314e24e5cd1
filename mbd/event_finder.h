// Finds the first event inside a step: where a watch value falls below zero.
//
// Looked at: the step's end, the stages inside it (free of charge), and, where a value's rate is known
// at both ends and steep enough to reach zero in between and come back, dense output: part by part, as far as the
// rates there let it be, down to the bottoms of its dips. Where nothing moves no error limits an adaptive step, and
// loads may rise and fall within it: it is looked at many times in each of their periods. Whatever raises suspicion is scanned on
// dense output, then the root is closed in on to rounding; all values that are negative on the far side
// of the bracket fire together.
//
// A value that belongs to a unit or friction whose mode has just changed is *fresh*: it starts at zero
// up to rounding and is not believed negative until it has been positive.
#pragma once

#include "mbd/integrators/integrator.h"
#include "mbd/root_estimate.h"

#include <array>
#include <limits>
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
  struct DipEnd {
    double theta, value, slope; ///< slope per unit of theta
  };
  bool follow_dip(Integrator& integrator, Dynamics& dynamics, int slot, const DipEnd& a, const DipEnd& b);
  void follow_dips(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh);
  void watch_rest(Integrator& integrator, Dynamics& dynamics);
  [[nodiscard]] bool is_negative_near(Integrator& integrator, Dynamics& dynamics, int slot, double middle, double reach);
  [[nodiscard]] double next_look(double middle);
  [[nodiscard]] double first_secant() const;
  struct Look {
    double theta = 0.0;
    std::vector<double> watch, rate; ///< rate: per unit of theta, NaN where it is not known
  };
  void watch_at(Integrator& integrator, Dynamics& dynamics, double theta, Look& look);
  static void look_at_end(const Integrator& integrator, bool is_last, Look& look);
  [[nodiscard]] bool crosses(const Look& low, const Look& high);
  [[nodiscard]] bool starts_negative(const Integrator& integrator, int slot) const;

  double shortest_period_; ///< of the loads, s
  int slots_;
  int unit_slots_; ///< those of contacts and springs come first
  bool is_resting_ = false; ///< nothing moves in the step: joints far from their limits are looked at, too
  double theta_ = 0.0;
  std::vector<double> y_, dy_;
  Look low_, high_, middle_;     ///< the bracket's ends, and a place between them
  static constexpr std::size_t k_most_known = 7;
  std::array<Look, k_most_known> known_; ///< the last ones, from which the next place is estimated
  std::size_t known_count_ = 0;
  RootEstimate estimate_;
  /// Of the root being closed in on, in parts of the step.
  struct Aim {
    double reach = 0.0;      ///< to either side of the root, where the bracket is to end
    double root = 0.0;       ///< as last estimated
    double distance = 1.0;   ///< of the last two estimates
    double expected = 1.0;   ///< error of the last one
    int looks = 0;           ///< estimates so far
    bool is_settled = false; ///< the root is as exact as it can be
  };
  Aim aim_;
  std::vector<double> look_at_;  ///< places inside the step to scan besides the even ones
  std::vector<int> dips_;        ///< slots whose bottom inside the step may be below zero
  int dip_looks_ = 0;            ///< at the present one
  std::vector<char> armed_;      ///< believed when negative
  std::vector<int> fired_, fired_before_;
};

} // namespace steplap
