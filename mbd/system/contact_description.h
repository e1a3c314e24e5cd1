// Describes a contact element to other parts of the program: its contact points, the largest valid penetration, and which bodies may tip.
// Each kind of contact provides the description (ElementKind::contact), so that warnings, the search for tipping and reports need no list
// of kinds.
#pragma once

#include "mbd/model/model.h"
#include "mbd/system/places.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Positions of markers and outlines in one state. Keeps references to its arguments.
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
  /// Returns the corners of a contour in ground axes, m, counter-clockwise: `given`, in the axes of the marker, or the outline of the
  /// marker's body if `given` is empty.
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

/// Properties of one contact element.
struct ContactDescription {
  /// The bodies that stand on corners or faces, for which a large rotation means tipping over. Wheels and rollers may rotate.
  enum class Standing : std::uint8_t { none, a, both };

  std::string a, b; ///< markers that touch
  Standing standing = Standing::none;
  bool is_preloaded = false;      ///< a preload or an interference presses it in the given pose
  bool has_ends = false;          ///< its face ends, and parts beside it may be below it without touching
  bool opening_ends_slip = false; ///< the contact has its own friction, which ends when it opens
  /// Largest penetration, m, for which the contact law is meaningful. At a larger one a part has passed through the other. Nothing: no
  /// limit.
  std::optional<double> depth_limit;
  /// Returns the points of contact; two points are the ends of a common face. Empty if the contact has no direction in this pose.
  std::vector<ContactPoint> (*points)(const Element& element, const ScenePose& pose) = nullptr;
};

/// Returns the description of a contact; nothing if the element is none.
[[nodiscard]] std::optional<ContactDescription> contact_of(const ElementEntry& entry, const Model& model);

/// Returns the thickness, m, of a marker's body along `normal`, measured in the outline behind the line through the marker that is
/// perpendicular to `normal` (in the marker's axes). Nothing if the body has no outline there.
[[nodiscard]] std::optional<double> thickness_behind(const Model& model, const std::string& marker, const Vec2& normal);

} // namespace steplap
