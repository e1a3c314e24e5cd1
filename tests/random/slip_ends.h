// Random slips that come to rest, one or two in a scene, against an integration of their own.
//
// A sheet slides on the ground under a force and a couple that its joint can bear: its overlap is always the whole sheet, so
// that in the sheet's axes its limit surface never changes. Its motion to rest is then three numbers and an angle, which
// follow() integrates by steps in proportion to the speed that is left: no event and no law of ends has a part in it.
#pragma once

#include "elements/step_lap/patch/limit_surface.h"

#include <string>
#include <vector>

namespace steplap::random {

/// A sheet about its centre of gravity, in its own axes, and how it is started: SI.
struct SlidingSheet {
  std::vector<Vec2> outline;
  double mass = 1.0, inertia = 1.0;
  double static_traction = 1.0, kinetic_traction = 1.0; ///< Pa
  Vec3 velocity = Vec3::Zero();                         ///< of the centre of gravity in ground axes, and of turning
  Vec3 load = Vec3::Zero();                             ///< force in ground axes, couple
};

/// How a sheet comes to rest.
struct SlipEnd {
  bool rests = false;
  double time = 0.0;
  Vec3 moved = Vec3::Zero(); ///< of the centre of gravity, and the angle
  struct Range {
    Vec3 least = Vec3::Zero(), most = Vec3::Zero();
  };
  /// Of the joint's wrench, the hold behind the end included: of all speeds that a run knows, and of any, the directions included
  /// that a run's errors make of the last speeds.
  Range surely, perhaps;
  double last_fall = 0.0; ///< m/s²: of its speed at last
  double fastest = 0.0;   ///< m/s
  double size = 0.0;      ///< m: radius of gyration of the traction
};

/// `tolerance`: of the steps of the run that is compared.
[[nodiscard]] SlipEnd follow(const SlidingSheet& sheet, double tolerance = 0.0);

struct SlipEndScene {
  std::vector<SlidingSheet> sheets;
  std::string integrator;
  double tolerance = 0.0; ///< of fixed steps: the step, of the first sheet's time
};

/// Every number of a scene comes from its seed.
[[nodiscard]] SlipEndScene slip_end_scene(std::uint64_t seed);

/// As a model file.
[[nodiscard]] std::string model_text(const SlipEndScene& scene);

/// What the run of a scene does that follow() does not; empty where they agree.
[[nodiscard]] std::string disagreement(const SlipEndScene& scene);

} // namespace steplap::random
