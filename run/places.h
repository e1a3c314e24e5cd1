// Where names of a model's markers and bodies are, in the pose of a state.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/system.h"

namespace steplap {

/// A place on a body, from its centre of gravity in its own axes.
struct Place {
  const Body* body = nullptr; ///< null: the ground
  Vec2 point = Vec2::Zero();  ///< m
  double angle = 0.0;         ///< rad, of its axes against the body's
};

/// Of a marker, or of a body's centre of gravity.
[[nodiscard]] Place place_of(const Model& model, const std::string& name);
/// (x, y, θ) of a body's centre of gravity; of the ground zero.
[[nodiscard]] Vec3 pose_of(const System& system, const State& state, const Body* body);
/// The body's index in the system; that of the ground for nullptr.
[[nodiscard]] int index_of(const System& system, const Body* body);
/// Is a contact of this element pressed, or held past the end of its face?
[[nodiscard]] bool is_closed(const System& system, const State& state, const std::string& element);

} // namespace steplap
