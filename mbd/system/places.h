// Positions of markers and bodies, by name, in a given state.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

namespace steplap {

/// A point and an orientation on a body, given relative to its centre of gravity and in its axes.
struct Place {
  const Body* body = nullptr; ///< null: the ground
  Vec2 point = Vec2::Zero();  ///< m
  double angle = 0.0;         ///< orientation relative to the body's axes, rad
};

/// Returns the position of a marker or of a body's centre of gravity.
[[nodiscard]] Place place_of(const Model& model, const std::string& name);
/// Returns (x, y, θ) of a body's centre of gravity; zero for the ground.
[[nodiscard]] Vec3 pose_of(const System& system, const State& state, const Body* body);
/// Returns the body's index in the system; k_ground for nullptr.
[[nodiscard]] int index_of(const System& system, const Body* body);
/// Returns true if the contact of this element is closed, that is, if its mode is not `open`.
[[nodiscard]] bool is_closed(const System& system, const State& state, const std::string& element);

} // namespace steplap
