// Reference poses of bodies from the coordinates of joints.
//
// A joint with a given coordinate ("the angle of a against b is 30 degrees") determines the pose of one of its bodies relative to the
// other, and its rate the velocity. Starting from the ground, fixed bodies and bodies with a given pose, poses are computed along the tree
// of such joints. Loops are closed later by assembly. A body whose pose is determined twice is an error, even if both agree.
#pragma once

#include "mbd/model/validate.h"

namespace steplap {

/// Pose and velocity of the frame of marker a relative to the frame of marker b.
struct RelativePose {
  Vec2 shift = Vec2::Zero();    ///< position of a relative to b, in the axes of b, m
  double angle = 0.0;           ///< angle of a relative to b, rad
  Vec2 velocity = Vec2::Zero(); ///< velocity of a as seen from b, in the axes of b, m/s
  double spin = 0.0;            ///< angular velocity of a relative to b, rad/s
};

/// Base class of elements that can prescribe the relative pose of their two bodies.
struct PlacingElement : Element {
  std::string a, b = "ground"; ///< markers
  /// Returns the prescribed relative pose, or nullopt if none is given.
  [[nodiscard]] virtual std::optional<RelativePose> relative_pose() const = 0;
  /// Returns the name of the field whose presence makes the element prescribe a pose.
  [[nodiscard]] virtual const char* placing_field() const = 0;
  /// Returns the name of a field that has no effect without placing_field(); null if there is none.
  [[nodiscard]] virtual const char* idle_field() const { return nullptr; }
};

/// Function that returns the location of a body's field in the file; nullopt if the field is not given.
using GivenBodyField = std::function<std::optional<Location>(std::size_t body, const std::string& field)>;

/// Sets pose and velocity of all bodies whose pose is determined by a joint. Precondition: positions of markers are known. Poses that are
/// determined twice or not at all are reported in `problems`; `locate` as in validate().
void place_by_joints(Model& model, const GivenBodyField& given, const FieldLocator& locate, std::vector<Diagnostic>& problems);

} // namespace steplap
