// Time stepping against the exact answer, for scenes of rubbing_bodies.h.
#pragma once

#include "tests/physics/rubbing_bodies.h"
#include "tests/physics/stepped.h"

#include <set>
#include <string>
#include <vector>

namespace steplap::testing {

using RubbingScene = RubbingBodies (*)(int seed, const Writing& writing);

/// The exact motion of a scene: by dop853, which locates each slip, with a tolerance of 1e-10.
class RubbingTruth {
public:
  RubbingTruth(RubbingScene make, int seed);

  /// With 3 % more friction everywhere and with 3 % less the same elements slide, as often: what a step of the first order makes
  /// of the loads does not decide.
  [[nodiscard]] bool is_robust() const { return is_robust_; }
  [[nodiscard]] int holding() const { return static_cast<int>(scene_.frictions.size() - slips_.size()); }
  [[nodiscard]] int sliding() const { return static_cast<int>(slips_.size()); }
  /// Runs the scene, written as `writing` says, with steps of `step`, s. Returns how it differs from the exact motion: friction that
  /// slides although it holds, or the other way round, or a body at another place; empty if it agrees.
  [[nodiscard]] std::string differs(RubbingScene make, int seed, double step, const Writing& writing) const;

private:
  RubbingBodies scene_;
  std::set<std::string> slips_;
  std::vector<double> places_;
  std::size_t changes_ = 0;
  bool is_robust_ = false;
};

} // namespace steplap::testing
