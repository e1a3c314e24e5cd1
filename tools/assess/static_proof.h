// Static proof: does a machine stand the constant accelerations that a standard asks for, and which one is too much in each direction?
//
// The machine is at rest on its vehicle; the pull of each load (static_preset.h) is laid over its gravity (static_machine.h). With friction
// there are many rests under one load, and which one a machine comes to hangs on what was before. So each load is asked in three ways:
// it grows from nothing; it grows from the same load turned round; friction between bodies bears nothing, as after
// hours of vibration (if there is a rest then: what needs friction to hold is taken to have it, which is said). Only what all of them
// bear is proven: where they disagree the verdict is open, and margins and reactions are the worst of them.
//
//   hold    there is a rest in all of these ways, and all criteria that a rest can answer are met
//   reject  the machine leaves its rest below the load, and it is known by what; or a criterion is not met
//   open    anything else: no rest was found and nothing explains it, nothing holds a body where it rests, the ways disagree, a margin
//           lies within rounding of its limit
#pragma once

#include "mbd/trust/judgement.h"
#include "run/tipping.h"
#include "tools/assess/static_preset.h"
#include "tools/assess/static_ray.h"

#include <functional>

namespace steplap::assess {

/// What something has to bear, and may.
struct StaticReaction {
  std::string name;   ///< of the channel
  double value = 0.0; ///< in `unit`, that of the way in which it is largest
  std::string unit;
  std::optional<double> allowed; ///< by a criterion of the model that bounds its size
};

/// A contact that pressed at rest.
struct StaticFoot {
  std::string name;
  bool lifts = false;  ///< in any of the ways
  double force = 0.0;  ///< N, when the load has grown from nothing
  double height = 0.0; ///< m, the largest
};

/// A step-lap joint by itself.
struct StaticJoint {
  std::string name;
  double margin = 0.0; ///< capacity over demand, the least of the ways; infinite without load
};

/// What became of one load.
struct StaticCase {
  StaticLoad load;
  Vec2 apparent = Vec2::Zero();    ///< gravity and pull, m/s²
  Verdict verdict = Verdict::open; ///< never "inspect": what is not met is not proven
  std::string why;                 ///< a sentence, where it is not "hold"
  std::string first;               ///< what gives way first while the pull grows, and where; "" if nothing does
  std::vector<StaticJoint> joints; ///< empty without a rest
  std::vector<StaticFoot> feet;
  std::vector<std::string> slid; ///< friction that slid to where it holds
  std::vector<StaticReaction> reactions;
  std::vector<CriterionResult> criteria; ///< that a rest can answer
  std::vector<Tipping> tipping;
  double moved = 0.0; ///< m, the furthest, from the rest without acceleration
  std::vector<std::string> remarks;
};

/// What a pull in one direction does.
struct StaticDirection {
  double angle = 0.0; ///< rad, counter-clockwise from x, of the pull
  StaticRay ray;
  bool is_unique = true; ///< other ways to the load bear what is just below its first limit, too
};

struct StaticProof {
  std::string model, file;
  std::vector<std::string> overrides;   ///< "path=value", laid over the file
  std::vector<std::string> assumptions; ///< sentences
  Plane plane = Plane::lengthwise;
  StaticPreset preset;
  Vec2 gravity = Vec2::Zero();
  std::vector<StaticCase> cases;
  std::vector<StaticDirection> polar;
  double largest = 0.0;             ///< m/s², beyond which directions are not followed
  Verdict verdict = Verdict::open;  ///< the worst of the cases
  std::string reason;               ///< a sentence
  std::vector<std::string> unasked; ///< criteria of the model that a rest cannot answer
};

struct StaticProofOptions {
  Plane plane = Plane::lengthwise;
  int directions = 72;
  double largest = 98.1;             ///< m/s²
  std::function<std::string()> stop; ///< asked between directions; what it says is why the work ends there
};

/// Throws NumericalFailure if the machine has no rest without acceleration, or if it was stopped.
[[nodiscard]] StaticProof prove_statically(const LoadedModel& loaded, const StaticPreset& preset, const StaticProofOptions& options);

/// "tips over", "slides away" or "" of the limit that a ray ends at: by what is at its limit there.
[[nodiscard]] std::string limit_words(const StaticRay& ray, std::size_t limit);

} // namespace steplap::assess
