#include "elements/views/kind_checks.h"

#include "elements/limit.h"
#include "elements/unilateral_contact.h"
#include "mbd/base/portable_math.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/system/places.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// Largest acceleration relative to that due to loads; a body that leans on a stiff stop is near its equilibrium.
constexpr double k_leans = 2.0;

// Checks the gap at the start. It can contradict the poses only if a gap, an interference or a preload is given, which shifts the contact
// line.
void check_gap(StartScene& scene, const ContactAtStart& contact, const UnilateralContact& foot) {
  if (!(foot.gap || foot.interference || foot.preload)) return;
  const State given = scene.system.initial_state();
  const Place a = place_of(scene.loaded.model, foot.a), b = place_of(scene.loaded.model, foot.b);
  const Vec3 at = pose_of(scene.system, given, a.body), on = pose_of(scene.system, given, b.body);
  const Vec2 normal = rotated(foot.normal, b.angle + on.z()).normalized();
  const Vec2 p_a = Vec2(at.x(), at.y()) + rotated(a.point, at.z()), p_b = Vec2(on.x(), on.y()) + rotated(b.point, on.z());
  Vec2 along = normal;
  if (foot.axis) along = rotated(*foot.axis, a.angle + at.z()).normalized();
  const double now = normal.dot(p_a - p_b) / normal.dot(along);
  const double depth =
      foot.preload ? portable::pow(*foot.preload / stiffness_of(foot), 1.0 / foot.exponent) : foot.interference.value_or(0.0);
  const double off =
      foot.gap ? now - *foot.gap : std::min({now, now + depth}, [](double x, double y) { return std::abs(x) < std::abs(y); });
  if (!(std::abs(off) > StartScene::k_off * size_of_pair(scene.system, contact.a, contact.b))) return;
  const std::string field = foot.gap ? "gap" : foot.interference ? "interference" : "preload";
  const double given_value = foot.gap ? *foot.gap : foot.interference ? *foot.interference : *foot.preload;
  const Vec2 line = p_a - (foot.gap ? *foot.gap : -depth) * along;
  const std::string side = now < 0.0 ? " behind" : " before";
  std::string text = "'" + foot.name + "': " + field + " = " + (foot.preload ? short_force(given_value) : short_length(given_value)) +
                     " contradicts the poses, by which its marker a is " + short_length(std::abs(now)) + side +
                     " the line through marker b: the line is taken to be " + short_length(std::abs(off)) +
                     " from there. If the poses are right, leave '" + field + "' out";
  if (!b.body)
    text += "; if the " + field + " is, b = { body = \"ground\", at = [" + three_digits(line.x()) + ", " + three_digits(line.y()) +
            "] } says the same without contradiction";
  scene.add("gap_contradicts_poses", foot.where, text);
}

// Returns true if the contact is a foot beyond an end of its face.
bool is_beside_face(const ContactAtStart& contact) {
  if (contact.entry->kind != &unilateral_contact_kind()) return false;
  const auto& ends = static_cast<const UnilateralContact&>(*contact.entry->element).ends;
  return ends && (*contact.along < ends->x() || *contact.along > ends->y());
}

// Reports a foot whose touching point is behind the line or near it, but beyond the end of the face, with no other contact below it.
void check_ends(StartScene& scene, const ContactAtStart& contact, const UnilateralContact& foot) {
  if (!foot.ends || !contact.along) return;
  const double beyond = std::max(foot.ends->x() - *contact.along, *contact.along - foot.ends->y());
  if (!(beyond > 0.0) || contact.gap > size_of_pair(scene.system, contact.a, contact.b)) return;
  const bool is_elsewhere = std::any_of(scene.contacts.begin(), scene.contacts.end(), [&](const ContactAtStart& other) {
    if (&other == &contact || (other.a != contact.a && other.b != contact.a)) return false;
    return !is_beside_face(other) && other.gap <= StartScene::k_off * size_of_pair(scene.system, other.a, other.b);
  });
  if (is_elsewhere) return;
  scene.add("foot_beside_face", foot.where,
            "'" + foot.name + "' begins " + short_length(beyond) + " outside its face: marker a is at " + three_digits(*contact.along) +
                " m along it, and 'ends' are " + three_digits(foot.ends->x()) + " m and " + three_digits(foot.ends->y()) +
                " m, counted along (n_y, -n_x) from marker b. Nothing carries it there");
}

} // namespace

void check_foot(StartScene& scene, const ContactAtStart& contact) {
  const auto& foot = static_cast<const UnilateralContact&>(*contact.entry->element);
  check_gap(scene, contact, foot);
  check_ends(scene, contact, foot);
}

void check_stops(StartScene& scene, const Element& element) {
  const auto& limit = static_cast<const Limit&>(element);
  const Place a = place_of(scene.loaded.model, limit.a), b = place_of(scene.loaded.model, limit.b);
  const bool is_angle = limit.coordinate == "angle", is_axis = limit.coordinate == "x" || limit.coordinate == "y";
  RowSpec row;
  row.a = index_of(scene.system, a.body);
  row.b = index_of(scene.system, b.body);
  row.point_a = a.point;
  row.point_b = b.point;
  row.kind = is_angle ? MeasureKind::angle : is_axis ? MeasureKind::axis : MeasureKind::distance;
  row.direction = rotated(limit.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0), b.angle);
  const auto value_at = [&](const State& state) {
    std::vector<Motion<double>> motion;
    place_bodies(state.q, state.v, motion);
    return evaluate_row<false>(row, motion.data()).value;
  };
  const double now = value_at(scene.start), zero = is_angle || is_axis ? value_at(scene.system.initial_state()) : 0.0;
  const double below = limit.lower ? zero + *limit.lower - now : 0.0, above = limit.upper ? now - zero - *limit.upper : 0.0;
  const double depth = std::max(below, above);
  if (!(depth > StartScene::k_typed * (is_angle ? 1.0 : size_of_pair(scene.system, row.a, row.b)))) return;
  const double sign = below > 0.0 ? 1.0 : -1.0, force = limit.stiffness * depth;
  const StartBalance::Opening opening = scene.balance.opening(sign * scene.balance.gradient(row), force);
  if (!(opening.acceleration > k_leans * opening.by_loads)) return;
  const std::string beyond = is_angle ? short_degrees(depth) : short_length(depth);
  scene.add("starts_beyond_stop", limit.where,
            "'" + limit.name + "' begins " + beyond + " beyond its " + (below > 0.0 ? "lower" : "upper") +
                " stop, which presses back with " + short_force(force, is_angle ? "N m" : "N") + ". " +
                (is_angle || is_axis ? "Stops count from the pose given, not from zero" : "Stops of a distance are that distance itself") +
                ": '" + (below > 0.0 ? "lower" : "upper") + "' was probably meant as " +
                (is_angle
                     ? short_degrees(below > 0.0 ? *limit.lower - depth : *limit.upper + depth) + " or " + (below > 0.0 ? "less" : "more")
                     : short_length(below > 0.0 ? *limit.lower - depth : *limit.upper + depth) + (below > 0.0 ? " or less" : " or more")));
}

} // namespace steplap
