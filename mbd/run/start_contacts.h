// Gap or contact force of each contact at the start of a run.
#pragma once

#include "mbd/run/loaded_model.h"

#include <optional>

namespace steplap {

/// A contact at the start of a run.
struct ContactAtStart {
  const ElementEntry* entry = nullptr; ///< its element in the model
  int contact = -1;                    ///< index of its force in an evaluation
  int a = k_ground, b = k_ground;      ///< bodies of the system
  double gap = 0.0;                    ///< gap, m; negative: penetration
  double force = 0.0;                  ///< contact force, N
  Vec2 place = Vec2::Zero();   ///< contact point in ground axes, m; for an open contact the point nearest to contact, for a face its middle
  std::optional<double> along; ///< for faces with ends: coordinate along the face from marker b, m
};

/// Returns the initial state of a run: projected onto the joints, and in equilibrium if the model requests this. `as_given`: without the
/// search for equilibrium.
[[nodiscard]] State beginning_of(const LoadedModel& loaded, bool as_given);

/// Returns all contacts in `state` with all velocities zero, in the order of the file.
[[nodiscard]] std::vector<ContactAtStart> contacts_at(const LoadedModel& loaded, const State& state);

/// Returns the radius of gyration of the smaller movable body of the pair, m.
[[nodiscard]] double size_of_pair(const System& system, int a, int b);

} // namespace steplap
