// A random scene put to the test: every method ends or stops cleanly, methods agree within their estimates, energy
// and momentum balance, friction does no work and stays within its bound, contacts do not pull.
#pragma once

#include "mbd/trust/cross_check.h"
#include "tests/random/scene.h"

namespace steplap::random {

struct SceneResult {
  std::string model_error; ///< the scene is no model: a fault of the generator
  CrossCheck check;        ///< its channels are gone with the scene's system: no trajectories to be looked at
  double seconds = 0.0;    ///< CPU time

  [[nodiscard]] bool is_bad() const { return !model_error.empty() || check.outcome == CrossOutcome::disagree; }
  /// "law: rodas5p 'b1' …", of the worst.
  [[nodiscard]] std::string text() const;
};

/// `folder`: where records are written for the reader. `evaluation_limit`: of one run, some seconds of computing.
[[nodiscard]] SceneResult check_scene(const Scene& scene, const std::string& folder, long evaluation_limit = 5'000'000);

/// The smallest scene, by leaving out blocks one after the other, in which something of the same kind is wrong
/// with one of the same methods.
[[nodiscard]] Scene shrunk(const Scene& scene, const SceneResult& result, const std::string& folder);

} // namespace steplap::random
