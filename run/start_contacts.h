// Contacts as the run begins: how far each is from touching, or how hard it presses, and where.
#pragma once

#include "run/loaded_model.h"

#include <optional>

namespace steplap {

/// One contact where the run begins.
struct ContactAtStart {
  const ElementEntry* entry = nullptr; ///< of the model
  int contact = -1;                    ///< index of its force in an evaluation
  int a = k_ground, b = k_ground;      ///< bodies of the system
  double gap = 0.0;                    ///< m, negative: pressed so deep
  double force = 0.0;                  ///< N
  Vec2 place = Vec2::Zero();           ///< of marker a, ground axes, m
  std::optional<double> along;         ///< m, of a face with ends: where on it, from marker b
};

/// The state that the run begins in: on the joints, at rest if the model asks for that. `as_given`: whatever it asks for.
[[nodiscard]] State beginning_of(const LoadedModel& loaded, bool as_given);

/// Of all contacts in `state`, with nothing moving, in the order of the file.
[[nodiscard]] std::vector<ContactAtStart> contacts_at(const LoadedModel& loaded, const State& state);

/// The bodies' size: the radius of gyration of the smaller of those that move, m.
[[nodiscard]] double size_of_pair(const System& system, int a, int b);

} // namespace steplap
