// Static proof: determines whether a machine withstands the constant accelerations required by a standard, and the limit in each direction.
//
// The machine is at rest on its vehicle, and the pull of each load (static_preset.h) is added to gravity (static_machine.h). With friction
// a load can have many equilibria, depending on the history. Each load is therefore applied along three loading paths: it grows from zero;
// it grows from the opposite load; friction between bodies is zero, as after hours of vibration (if an equilibrium then exists; otherwise
// friction is assumed to hold, which is reported). A load is proven only if all paths have an equilibrium. If they disagree, the verdict is
// open. Margins and reactions are the worst of all paths.
//
//   hold    all paths have an equilibrium, and all criteria that can be evaluated at rest are met
//   reject  the machine leaves its equilibrium below the load for a known reason, or a criterion is not met
//   open    otherwise: no equilibrium was found without an explanation, a body is not held by any element, the paths disagree, a
//           margin is within rounding of its limit, a run of the model could not mean "hold" either, or the model has an action that
//           acts later, or at this rest
#pragma once

#include "mbd/run/tipping.h"
#include "mbd/trust/judgement.h"
#include "tools/assess/static_preset.h"
#include "tools/assess/static_ray.h"

#include <functional>

namespace steplap::assess {

/// Largest value of a reaction over all loading paths, with its limit.
struct StaticReaction {
  std::string name;   ///< name of the channel
  double value = 0.0; ///< value in `unit`, from the path in which its magnitude is largest
  std::string unit;
  std::optional<double> allowed; ///< limit, if a criterion of the model limits the magnitude
};

/// A contact that is closed under gravity alone.
struct StaticFoot {
  std::string name;
  bool lifts = false;  ///< true if it opens along any of the loading paths
  double force = 0.0;  ///< contact force after the load has grown from zero, N
  double height = 0.0; ///< largest gap over all loading paths, m
};

/// Result for a step-lap joint.
struct StaticJoint {
  std::string name;
  double margin = 0.0; ///< smallest ratio of capacity to demand over all paths; infinite without load
};

/// Result for one load.
struct StaticCase {
  StaticLoad load;
  Vec2 apparent = Vec2::Zero();    ///< gravity plus pull, m/s²
  Verdict verdict = Verdict::open; ///< hold, open or reject; "inspect" is not used, because a limit that is exceeded is not proven
  std::string why;                 ///< sentence with the reason of a verdict other than "hold"
  std::string first;               ///< first limit reached while the pull grows, with its acceleration; "" if none
  std::vector<StaticJoint> joints; ///< empty if there is no equilibrium
  std::vector<StaticFoot> feet;
  std::vector<std::string> slid; ///< names of friction elements that slid before the machine found a new equilibrium
  std::vector<StaticReaction> reactions;
  std::vector<CriterionResult> criteria; ///< criteria that can be evaluated at rest
  std::vector<Tipping> tipping;
  double moved = 0.0; ///< largest displacement from the equilibrium without acceleration, m
  std::vector<std::string> remarks;
};

/// Result for a pull in one direction.
struct StaticDirection {
  double angle = 0.0; ///< direction of the pull, rad, counter-clockwise from x
  StaticRay ray;
  /// True if the load just below the first limit also has an equilibrium when it grows from the opposite pull, not from zero.
  bool is_unique = true;
};

/// Results of a static proof for one model.
struct StaticProof {
  std::string model, file;
  std::string drawing;                  ///< drawing of the model as JSON (run/drawing.h)
  std::vector<std::string> overrides;   ///< "path=value", applied to the file
  std::vector<std::string> assumptions; ///< assumptions of the proof, as sentences
  Plane plane = Plane::lengthwise;
  StaticPreset preset;
  Vec2 gravity = Vec2::Zero();
  std::vector<StaticCase> cases;
  std::vector<StaticDirection> polar;
  double largest = 0.0;             ///< largest pull examined in each direction, m/s²
  Verdict verdict = Verdict::open;  ///< worst of the cases
  std::string reason;               ///< sentence with the reason of the verdict
  std::vector<std::string> caps;    ///< reasons why the model cannot be proven to hold, as in a run (Judgement::caps), and its actions
  std::vector<std::string> unasked; ///< names of the model's criteria that cannot be evaluated at rest
};

/// Options of a static proof.
struct StaticProofOptions {
  Plane plane = Plane::lengthwise;
  int directions = 72;
  double largest = 98.1;             ///< largest pull to be examined, m/s²
  std::function<std::string()> stop; ///< called between directions; a non-empty text stops the work and becomes its reason
};

/// Runs the proof. Throws NumericalFailure if the machine has no equilibrium without acceleration, or if stopped.
[[nodiscard]] StaticProof prove_statically(const LoadedModel& loaded, const StaticPreset& preset, const StaticProofOptions& options);

/// Returns a text for limit number `limit` of the ray: the element that slips, slides or lifts. For the loss of equilibrium (`ends`) it
/// names the limits that were reached at the same acceleration, for example "'foot' slides away" or "the machine tips over as 'foot'
/// lifts".
[[nodiscard]] std::string limit_text(const StaticRay& ray, std::size_t limit);

} // namespace steplap::assess
