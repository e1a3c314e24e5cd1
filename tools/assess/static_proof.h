// Static proof: determines whether a machine withstands the constant accelerations required by a standard, and the limit in each direction.
//
// The machine is at rest on its vehicle, and the pull of each load (static_preset.h) is added to its gravity (static_machine.h). With
// friction one load can have many equilibria, depending on the history. Each load is therefore computed in three ways: it grows from zero;
// it grows from the opposite load; friction between bodies carries nothing, as after hours of vibration (if an equilibrium then exists;
// otherwise friction is assumed to hold, which is reported). A load is proven only if all ways give an equilibrium. If they disagree the
// verdict is open. Margins and reactions are the worst of all ways.
//
//   hold    all ways have an equilibrium, and all criteria that can be evaluated at rest are met
//   reject  the machine leaves its equilibrium below the load for a known reason, or a criterion is not met
//   open    otherwise: no equilibrium was found without an explanation, a body at rest is held by nothing, the ways disagree, or
//           a margin is within rounding of its limit
#pragma once

#include "mbd/run/tipping.h"
#include "mbd/trust/judgement.h"
#include "tools/assess/static_preset.h"
#include "tools/assess/static_ray.h"

#include <functional>

namespace steplap::assess {

/// A reaction with its limit.
struct StaticReaction {
  std::string name;   ///< name of the channel
  double value = 0.0; ///< in `unit`; of the way in which it is largest
  std::string unit;
  std::optional<double> allowed; ///< limit, if a criterion of the model limits the magnitude
};

/// A contact that was pressed at rest.
struct StaticFoot {
  std::string name;
  bool lifts = false;  ///< true if it lifts in any of the ways
  double force = 0.0;  ///< N, after the load has grown from zero
  double height = 0.0; ///< largest gap, m
};

/// Result for a step-lap joint.
struct StaticJoint {
  std::string name;
  double margin = 0.0; ///< capacity over demand, smallest of all ways; infinite without load
};

/// Result for one load.
struct StaticCase {
  StaticLoad load;
  Vec2 apparent = Vec2::Zero();    ///< gravity plus pull, m/s²
  Verdict verdict = Verdict::open; ///< never "inspect": a limit that is not met is not proven
  std::string why;                 ///< reason if not "hold", a sentence
  std::string first;               ///< first limit that the growing pull reaches, with its acceleration; "" if none
  std::vector<StaticJoint> joints; ///< empty if there is no equilibrium
  std::vector<StaticFoot> feet;
  std::vector<std::string> slid; ///< friction elements that slid to a new equilibrium
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
  bool is_unique = true; ///< true if the other ways also have an equilibrium just below the first limit
};

/// Results of a static proof for one model.
struct StaticProof {
  std::string model, file;
  std::string drawing;                  ///< of the model, JSON (run/drawing.h)
  std::vector<std::string> overrides;   ///< "path=value", applied to the file
  std::vector<std::string> assumptions; ///< sentences
  Plane plane = Plane::lengthwise;
  StaticPreset preset;
  Vec2 gravity = Vec2::Zero();
  std::vector<StaticCase> cases;
  std::vector<StaticDirection> polar;
  double largest = 0.0;             ///< largest pull that was examined in each direction, m/s²
  Verdict verdict = Verdict::open;  ///< worst of the cases
  std::string reason;               ///< a sentence
  std::vector<std::string> unasked; ///< criteria of the model that cannot be evaluated at rest
};

/// Options of a static proof.
struct StaticProofOptions {
  Plane plane = Plane::lengthwise;
  int directions = 72;
  double largest = 98.1;             ///< m/s²
  std::function<std::string()> stop; ///< polled between directions; a text other than "" stops the work and becomes the reason
};

/// Runs the proof. Throws NumericalFailure if the machine has no equilibrium without acceleration, or if stopped.
[[nodiscard]] StaticProof prove_statically(const LoadedModel& loaded, const StaticPreset& preset, const StaticProofOptions& options);

/// Returns text for entry `limit` of ray.limits: which element slips, slides or lifts. If this entry is the loss of equilibrium (`ends`),
/// the text names the limits that were reached at the same acceleration, such as "'foot' slides away" or "the machine tips over as 'foot'
/// lifts".
[[nodiscard]] std::string limit_words(const StaticRay& ray, std::size_t limit);

} // namespace steplap::assess
