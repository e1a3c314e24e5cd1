#include "elements/views/kind_checks.h"

#include "elements/joints.h"
#include "mbd/base/number_text.h"
#include "mbd/run/quantity_text.h"
#include "mbd/system/places.h"

#include <cmath>
#include <cstdio>

namespace steplap {

namespace {

constexpr double k_far = 0.1; // largest distance of the ends, relative to the radius of gyration; rounding of given poses is smaller

std::string rounded(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", value + 0.0);
  return text;
}

} // namespace

std::vector<Finding> far_joints(const LoadedModel& loaded) {
  std::vector<Finding> found;
  const State given = loaded.system->initial_state();
  for (const ElementEntry& entry : loaded.model.elements) {
    const auto* const joint = dynamic_cast<const Joint*>(entry.element.get());
    if (!joint || !joint->active || entry.kind != &revolute_kind() || joint->b != "ground") continue;
    const Place a = place_of(loaded.model, joint->a);
    if (!a.body || !(a.body->mass > 0.0)) continue;
    const Vec3 pose = pose_of(*loaded.system, given, a.body);
    const Vec2 at = Vec2(pose.x(), pose.y()) + rotated(a.point, pose.z());
    if (!(at.norm() > k_far * std::sqrt(a.body->inertia / a.body->mass))) continue;
    found.push_back({"far_joint", FindingLevel::warning,
                     "revolute '" + joint->name + "' pins '" + a.body->name +
                         "' to the ground's origin, since its 'b' names no place; in the pose given 'a' is " +
                         quantity_text(at.norm(), "m", 1e-3) + " from there. A pin where 'a' is has b = { body = \"ground\", at = [" +
                         rounded(at.x()) + ", " + rounded(at.y()) + "] }",
                     joint->where});
  }
  return found;
}

} // namespace steplap
