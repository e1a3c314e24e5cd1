// Reference poses of bodies from the joints that join them: angles and displacements instead of places.
//
// A joint that gives its coordinate ("the angle of a against b is 30 degrees") places one of its two bodies
// against the other. From the ground, fixed bodies and bodies that give a pose of their own this goes along
// the joints, as far as a tree of them reaches; loops are left to assembly. A body's velocity follows in the
// same way, from the joint's rate. Each body is placed once: what is said twice is an error, though it agree.
#pragma once

#include "mbd/model/validate.h"

namespace steplap {

/// Frame of marker a as seen from the frame of marker b, and how it moves there.
struct RelativePose {
  Vec2 shift = Vec2::Zero();    ///< of marker a from marker b, in b's axes, m
  double angle = 0.0;           ///< of a's axes against b's, rad
  Vec2 velocity = Vec2::Zero(); ///< of marker a as seen from b, in b's axes, m/s
  double spin = 0.0;            ///< rad/s
};

/// An element that may say where its two bodies are against each other.
struct PlacingElement : Element {
  std::string a, b = "ground"; ///< markers
  /// Nullopt: it does not say.
  [[nodiscard]] virtual std::optional<RelativePose> relative_pose() const = 0;
  /// The field that decides whether it says so.
  [[nodiscard]] virtual const char* placing_field() const = 0;
  /// A field that is given in vain without it; null if there is none.
  [[nodiscard]] virtual const char* idle_field() const { return nullptr; }
};

/// Where the file gives a body's field; nullopt: it does not give it.
using GivenBodyField = std::function<std::optional<Location>(std::size_t body, const std::string& field)>;

/// Sets pose and velocity of every body that joints place. Markers need their places. Adds what is
/// contradictory, said twice or never said to `problems`; `locate` as in validate().
void place_by_joints(Model& model, const GivenBodyField& given, const FieldLocator& locate, std::vector<Diagnostic>& problems);

} // namespace steplap
