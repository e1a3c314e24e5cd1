// The scene's own length and times, from which follows what counts as many events in a short time: a model whose lengths and times
// are scaled is judged the same way. Not all tolerances follow them yet (KNOWN_ISSUES.md).
#pragma once

namespace steplap {

struct SceneUnits {
  double length = 1.0;   ///< m: the largest radius of gyration, √(J/m)
  double duration = 1.0; ///< s: that the model runs for
  double rate = 1.0;     ///< 1/s: √(g/length), by gravity g; without it π/duration

  [[nodiscard]] double time() const { return 1.0 / rate; }
};

} // namespace steplap
