// Characteristic length and times of a scene. Thresholds such as "many events in a short time" scale with them, so that a scaled model gets
// the same result. Some tolerances do not use them yet (KNOWN_ISSUES.md).
#pragma once

namespace steplap {

/// Characteristic values of one scene.
struct SceneUnits {
  double length = 1.0;   ///< largest radius of gyration √(J/m), m
  double duration = 1.0; ///< duration of the run, s
  double rate = 1.0;     ///< √(g/length), 1/s; π/duration without gravity

  [[nodiscard]] double time() const { return 1.0 / rate; }
};

} // namespace steplap
