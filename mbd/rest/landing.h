// Shortens a step of the descent such that many bodies land in it, each at its own first contact.
//
// An island is a set of bodies connected by rows, springs or closed contacts. Islands do not affect each other until a contact between them
// closes. Each island that nothing supports is therefore moved to its own first contact, and all land in one step. If the whole step were
// cut at the first contact, as in a small model, each landing body would need a step.
#pragma once

#include "mbd/rest/statics.h"

#include <functional>
#include <vector>

namespace steplap {

class Landing {
public:
  /// Uses the last evaluation of `statics`, which must outlive this object.
  Landing(const System& system, const Statics& statics);

  struct StepProbe {
    std::function<void(const VecX& step)> at;     ///< evaluates the statics at a displacement from the start of the step
    std::function<double(const VecX& step)> room; ///< fraction of a step from there that is safe until gaps are measured again
  };
  /// Shortens the part of `step` that moves each island, such that its first contact has just closed. `measurements`: number of gap
  /// measurements along the path of each body, 0 for the ground. `touch`: penetration after closing, m, so that rounding does not open the
  /// contact again. Returns false and leaves the step unchanged if no contact closes, or if one closes within an island or between two
  /// supported islands. Leaves the statics at an arbitrary pose.
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
  std::vector<char> is_carried_; ///< for each island: it has a closed contact
  // For each island: fractions of the step between which its first contact closes, and the contacts that close there.
  std::vector<double> low_, high_;
  std::vector<std::vector<int>> landed_;
};

} // namespace steplap
