// Cuts a step of the descent so that many bodies land in it, each at its own first contact.
//
// An island is a set of bodies connected by rows, springs or closed contacts. Islands do not affect each other before a contact between
// them closes. So each island that nothing supports moves up to its own first contact, and all land in one step. Cutting the whole step at
// the first contact, as in a small model, would take one step for each landing body.
#pragma once

#include "mbd/rest/statics.h"

#include <functional>
#include <vector>

namespace steplap {

class Landing {
public:
  /// Uses the last evaluation of `statics`.
  Landing(const System& system, const Statics& statics);

  struct StepProbe {
    std::function<void(const VecX& step)> at;     ///< evaluates the statics at a displacement from the start of the step
    std::function<double(const VecX& step)> room; ///< share of a step that is safe from there before the next measurement of gaps
  };
  /// Cuts the part of `step` of each island where its first contact has just closed. `measurements`: number of measurements along each
  /// body's path, 0 for the ground. `touch`: penetration after closing, m, so that rounding does not open the contact again. Returns false
  /// and leaves the step unchanged if no contact closes, or one within an island or between two supported ones. The statics is left at an
  /// arbitrary pose.
  bool cut(VecX& step, const std::vector<double>& measurements, double touch, const StepProbe& probe);

private:
  struct Pair {
    int a = 0, b = 0, contact = 0;
  };
  void join_bodies();
  [[nodiscard]] int island(int body);
  [[nodiscard]] VecX cut_step(const VecX& step, const std::vector<double>& shares);
  [[nodiscard]] int lander(const Pair& pair, const VecX& step);
  [[nodiscard]] double next_share(const VecX& step, const std::vector<double>& measurements, const StepProbe& probe, double share);
  [[nodiscard]] bool has_stopped(int island, double share) const;
  [[nodiscard]] bool find_first(const VecX& step, const std::vector<double>& measurements, const StepProbe& probe);
  void locate_contact(const VecX& step, const StepProbe& probe);

  const System& system_;
  const Statics& statics_;
  std::vector<int> parent_;      ///< union-find over bodies; 0 is the ground, which connects nothing
  std::vector<Pair> open_;       ///< contacts that may close
  std::vector<char> is_carried_; ///< islands with a closed contact
  // Per island: shares of the step between which its first contact closes, and the contacts that close.
  std::vector<double> low_, high_;
  std::vector<std::vector<int>> landed_;
};

} // namespace steplap
