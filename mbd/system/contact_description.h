// Describes a contact element: where it touches, how deep it may be pressed, which bodies stand on it. Each kind of contact fills in the
// description (ElementKind::contact), so that findings, tipping and stories need no list of kinds.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/places.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Poses of markers and outlines in a state. Keeps references.
class ScenePose {
public:
  ScenePose(const Model& model, const System& system, const State& state) : model_(model), system_(system), state_(state) {}

  /// A marker in ground axes.
  struct PlacedMarker {
    int body = k_ground;       ///< body of the system
    Vec2 point = Vec2::Zero(); ///< m
    double angle = 0.0;        ///< rad
  };
  /// Returns the pose of a marker, or of a body's centre of gravity.
  [[nodiscard]] PlacedMarker marker(const std::string& name) const;
  /// Returns corners in ground axes, m, counter-clockwise: `given` in the marker's axes, or if that is empty the outline of its body.
  [[nodiscard]] std::vector<Vec2> outline(const std::string& marker, const std::vector<Vec2>& given) const;

private:
  const Model& model_;
  const System& system_;
  const State& state_;
};

/// A point at which a contact touches, or would touch.
struct ContactPoint {
  Vec2 point = Vec2::Zero();  ///< m, ground axes
  Vec2 normal = Vec2::Zero(); ///< unit direction of the force on a
};

/// Answers of one contact element.
struct ContactDescription {
  /// Bodies that stand in contact by corners or faces, so that a large rotation means that they tip. Wheels and rollers turn.
  enum class Standing : std::uint8_t { none, a, both };

  std::string a, b; ///< markers that touch
  Standing standing = Standing::none;
  bool is_preloaded = false;      ///< a preload or an interference presses it in the given pose
  bool opening_ends_slip = false; ///< the contact has its own friction, which ends when it opens
  /// Largest penetration, m, for which the law is meaningful; a deeper one means that one part is through the other. Nothing: no limit.
  std::optional<double> depth_limit;
  /// Returns where the contact touches; two points are the ends of a common face. Empty: it has no direction in this pose.
  std::vector<ContactPoint> (*points)(const Element& element, const ScenePose& pose) = nullptr;
};

/// Returns the description of a contact; nothing if the element is none.
[[nodiscard]] std::optional<ContactDescription> contact_of(const ElementEntry& entry, const Model& model);

/// Returns the thickness, m, of the outline of a marker's body behind the line through the marker with normal `normal`, in its axes. Nothing
/// if the body has no outline there.
[[nodiscard]] std::optional<double> thickness_behind(const Model& model, const std::string& marker, const Vec2& normal);

} // namespace steplap
