// Finds the points at which bodies stand on each other: feet, wheels and corners in contact.
#pragma once

#include "mbd/run/loaded_model.h"

namespace steplap {

/// A contact point. Two outlines whose faces touch have two, at the ends of the common length.
struct Foot {
  std::string element;            ///< name of the contact element
  std::string name;               ///< name of the contact, for a face with the end
  int a = k_ground, b = k_ground; ///< indices of bodies in the system
  Vec2 point = Vec2::Zero();      ///< point, m, ground axes
  Vec2 normal = Vec2::Zero();     ///< unit vector in the direction of the force on a
};

/// Returns the points of all contacts that are closed in `state`, or open by less than 0.001 of the size of the bodies, because in a given
/// pose contacts may only just touch.
[[nodiscard]] std::vector<Foot> feet_of(const LoadedModel& loaded, const State& state);

} // namespace steplap
