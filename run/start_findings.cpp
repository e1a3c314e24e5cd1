// Finds contradictions between the initial state and other data of the model.
#include "elements/limit.h"
#include "elements/unilateral_contact.h"
#include "mbd/base/decompositions.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/system/actions.h"
#include "mbd/system/contact_description.h"
#include "mbd/system/own_states.h"
#include "run/body_reach.h"
#include "run/findings.h"
#include "run/quantity_text.h"
#include "run/start_balance.h"
#include "run/start_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace steplap {

namespace {

constexpr double k_unanswered = 10.0; // times the acceleration due to loads; contacts that settle under loads stay within a few times of it
constexpr double k_leans = 2.0;       // the same for stops, which are stiff: a body leaning on a stop is near its equilibrium
constexpr double k_felt = 0.1;        // of gravity; smaller accelerations come from rounded poses or clearance
constexpr double k_typed = 1e-6;      // of the bodies' size; rounding of typed poses
constexpr double k_through = 0.5;     // of the depth at which a contact law becomes invalid
constexpr double k_off = 1e-3;        // of the bodies' size; larger deviations are not rounding
constexpr double k_light = 0.01;      // of a homogeneous plate's moment of inertia; its radius of gyration is then a tenth of the plate's
constexpr double k_changes = 1e-3;    // relative to a state's scale, within the run
// times the largest moment of inertia possible within the outline, with all mass at the farthest corner; outlines are approximate.
constexpr double k_heavy = 2.0;
// Ratios of the radius of gyration to the farthest point of the body, and to the size of the scene, above which it is implausible. A
// flywheel may have only its crank pin as a point.
constexpr double k_beyond_places = 10.0, k_beyond_scene = 2.0;

std::string rounded(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.3g", value + 0.0);
  return text;
}
// Rounds to three digits, which suffice to identify a value.
std::string short_text(double value, const char* unit) { return quantity_text(std::strtod(rounded(value).c_str(), nullptr), unit); }
std::string length_text(double value) { return short_text(value, "m"); }
std::string force_text(double value, const char* unit = "N") { return short_text(value, unit); }
std::string degrees_text(double angle) { return rounded(angle * 180.0 / std::numbers::pi) + "°"; }

class StartFinder {
public:
  explicit StartFinder(const LoadedModel& loaded)
      : loaded_(loaded), system_(*loaded.system), start_(beginning_of(loaded, true)), balance_(system_, start_) {}

  std::vector<Finding> run() {
    contacts_ = contacts_at(loaded_, start_);
    for (const ContactAtStart& contact : contacts_) check_gap(contact);
    for (const ContactAtStart& contact : contacts_) check_ends(contact);
    // The search for an equilibrium also starts from these poses.
    if (loaded_.model.simulation.initial != "equilibrium") {
      for (const ContactAtStart& contact : contacts_) check_depth(contact);
      for (const ElementEntry& entry : loaded_.model.elements)
        if (const auto* const limit = dynamic_cast<const Limit*>(entry.element.get())) check_stops(*limit);
    }
    const std::vector<double> reaches = body_reaches(loaded_.model);
    const double extent = scene_extent(loaded_.model, reaches);
    for (std::size_t i = 0; i < loaded_.model.bodies.size(); ++i) {
      const Body& body = loaded_.model.bodies[i];
      if (body.fixed || !(body.mass > 0.0)) continue;
      if (body.outline.size() >= 3) check_inertia(body);
      else check_gyration(body, reaches[i], extent);
    }
    if (loaded_.model.simulation.initial == "equilibrium") check_states();
    return std::move(found_);
  }

private:
  void add(const char* code, const Location& where, std::string text) {
    found_.push_back({code, FindingLevel::warning, std::move(text), where});
  }
  [[nodiscard]] bool springs_apart(const StartBalance::Opening& opening) const {
    return opening.acceleration > k_unanswered * std::max(opening.by_loads, k_felt * system_.gravity.norm());
  }

  // In the search for an equilibrium inner states keep their initial values. If they change afterwards, the machine leaves the equilibrium.
  void check_states() {
    const std::vector<const OwnState*> states = own_states(loaded_.model);
    const auto* group = states.empty() ? nullptr : own_state_group(system_);
    if (!group) return;
    Dynamics dynamics(system_);
    dynamics.set_state(start_);
    std::vector<double> y(static_cast<std::size_t>(system_.largest_dimension())), dy(y.size());
    dynamics.pack(start_, y.data());
    dynamics.rates(start_.t, y.data(), dy.data());
    for (const OwnStateGroup::ElementData& entry : group->entries) {
      const OwnState& state = *states[static_cast<std::size_t>(entry.place.inner - group->first_inner)];
      const double rate =
          dy[static_cast<std::size_t>(2 * dynamics.coordinate_count() + entry.place.inner)] * entry.place.unit / state.factor();
      const double scale = state.scale.value_or(state.start != 0.0 ? std::abs(state.start) : 1.0);
      if (!(std::abs(rate) * loaded_.model.simulation.end > k_changes * scale)) continue;
      const std::string unit = state.unit.empty() ? "" : " " + state.unit;
      add("state_leaves_equilibrium", state.where,
          "state '" + state.name + "' starts at " + rounded(state.start) + unit + " and changes by " + rounded(rate) + unit +
              " per second from there: the machine is at rest with it for a moment only. " +
              "If it is to stay at rest, give it the start at which its rate is zero");
    }
  }

  // A gap, an interference or a preload shifts the contact line, so the position of marker b does not matter.
  void check_gap(const ContactAtStart& contact) {
    const auto* const foot = dynamic_cast<const UnilateralContact*>(contact.entry->element.get());
    if (!foot || !(foot->gap || foot->interference || foot->preload)) return;
    const State given = system_.initial_state();
    const Place a = place_of(loaded_.model, foot->a), b = place_of(loaded_.model, foot->b);
    const Vec3 at = pose_of(system_, given, a.body), on = pose_of(system_, given, b.body);
    const Vec2 normal = rotated(foot->normal, b.angle + on.z()).normalized();
    const Vec2 p_a = Vec2(at.x(), at.y()) + rotated(a.point, at.z()), p_b = Vec2(on.x(), on.y()) + rotated(b.point, on.z());
    Vec2 along = normal;
    if (foot->axis) along = rotated(*foot->axis, a.angle + at.z()).normalized();
    const double now = normal.dot(p_a - p_b) / normal.dot(along);
    const double depth = foot->preload
                             ? portable::pow(*foot->preload / (foot->stiffness * static_cast<double>(foot->count)), 1.0 / foot->exponent)
                             : foot->interference.value_or(0.0);
    const double off =
        foot->gap ? now - *foot->gap : std::min({now, now + depth}, [](double x, double y) { return std::abs(x) < std::abs(y); });
    if (!(std::abs(off) > k_off * size_of_pair(system_, contact.a, contact.b))) return;
    const std::string field = foot->gap ? "gap" : foot->interference ? "interference" : "preload";
    const double given_value = foot->gap ? *foot->gap : foot->interference ? *foot->interference : *foot->preload;
    const Vec2 line = p_a - (foot->gap ? *foot->gap : -depth) * along;
    const std::string side = now < 0.0 ? " behind" : " before";
    std::string text = "'" + foot->name + "': " + field + " = " + (foot->preload ? force_text(given_value) : length_text(given_value)) +
                       " contradicts the poses, by which its marker a is " + length_text(std::abs(now)) + side +
                       " the line through marker b: the line is taken to be " + length_text(std::abs(off)) +
                       " from there. If the poses are right, leave '" + field + "' out";
    if (!b.body)
      text += "; if the " + field + " is, b = { body = \"ground\", at = [" + rounded(line.x()) + ", " + rounded(line.y()) +
              "] } says the same without contradiction";
    add("gap_contradicts_poses", foot->where, text);
  }

  // The touching point is behind the line or near it, but beyond the end of the face, and no other contact is below it.
  void check_ends(const ContactAtStart& contact) {
    const auto* const foot = dynamic_cast<const UnilateralContact*>(contact.entry->element.get());
    if (!foot || !foot->ends || !contact.along) return;
    const double beyond = std::max(foot->ends->x() - *contact.along, *contact.along - foot->ends->y());
    if (!(beyond > 0.0) || contact.gap > size_of_pair(system_, contact.a, contact.b)) return;
    const bool is_elsewhere = std::any_of(contacts_.begin(), contacts_.end(), [&](const ContactAtStart& other) {
      if (&other == &contact || (other.a != contact.a && other.b != contact.a)) return false;
      const auto* const face = dynamic_cast<const UnilateralContact*>(other.entry->element.get());
      const bool is_beside = face && face->ends && (*other.along < face->ends->x() || *other.along > face->ends->y());
      return !is_beside && other.gap <= k_off * size_of_pair(system_, other.a, other.b);
    });
    if (is_elsewhere) return;
    add("foot_beside_face", foot->where,
        "'" + foot->name + "' begins " + length_text(beyond) + " beside its face: marker a is at " + rounded(*contact.along) +
            " m along it, and 'ends' are " + rounded(foot->ends->x()) + " m and " + rounded(foot->ends->y()) +
            " m, counted along (n_y, -n_x) from marker b. Nothing carries it there");
  }

  void check_depth(const ContactAtStart& contact) {
    const Element& element = *contact.entry->element;
    const double size = size_of_pair(system_, contact.a, contact.b), depth = -contact.gap;
    if (!(contact.force > 0.0) || !(depth > k_typed * size)) return;
    const VecX gradient = balance_.gap_gradient(contact.contact);
    if (gradient.size() == 0) return;
    const StartBalance::Opening opening = balance_.opening(gradient);
    const auto most = contact_of(*contact.entry, loaded_.model)->depth_limit;
    const bool is_through = most && depth > k_through * *most;
    if (!is_through && !springs_apart(opening)) return;
    const int body = contact.a != k_ground ? contact.a : contact.b;
    const Vec2 out(gradient[3 * body - 3], gradient[3 * body - 2]);
    std::string text = "'" + element.name + "' begins pressed " + length_text(depth) + " deep, with " + force_text(contact.force);
    text += springs_apart(opening) ? ", and nothing balances that: it springs apart with " + rounded(opening.acceleration) + " m/s²"
                                   : ": one part is half through the other";
    if (const auto* const foot = dynamic_cast<const UnilateralContact*>(&element); foot && (foot->preload || foot->interference))
      text += ". A preload or an interference needs its answer: the other side of the same clamp, or a load";
    else
      text += ". Moved by " + length_text(depth) + " along [" + rounded(out.x()) + ", " + rounded(out.y()) + "] '" +
              system_.bodies[body].name + "' would just touch; initial = \"equilibrium\" begins where it rests";
    add("starts_deep", element.where, text);
  }

  void check_stops(const Limit& limit) {
    const Place a = place_of(loaded_.model, limit.a), b = place_of(loaded_.model, limit.b);
    const bool is_angle = limit.coordinate == "angle", is_axis = limit.coordinate == "x" || limit.coordinate == "y";
    RowSpec row;
    row.a = index_of(system_, a.body);
    row.b = index_of(system_, b.body);
    row.point_a = a.point;
    row.point_b = b.point;
    row.kind = is_angle ? MeasureKind::angle : is_axis ? MeasureKind::axis : MeasureKind::distance;
    row.direction = rotated(limit.coordinate == "x" ? Vec2(1.0, 0.0) : Vec2(0.0, 1.0), b.angle);
    const auto value_at = [&](const State& state) {
      std::vector<Motion<double>> motion;
      place_bodies(state.q, state.v, motion);
      return evaluate_row<false>(row, motion.data()).value;
    };
    const double now = value_at(start_), zero = is_angle || is_axis ? value_at(system_.initial_state()) : 0.0;
    const double below = limit.lower ? zero + *limit.lower - now : 0.0, above = limit.upper ? now - zero - *limit.upper : 0.0;
    const double depth = std::max(below, above);
    if (!(depth > k_typed * (is_angle ? 1.0 : size_of_pair(system_, row.a, row.b)))) return;
    const double sign = below > 0.0 ? 1.0 : -1.0, force = limit.stiffness * depth;
    const StartBalance::Opening opening = balance_.opening(sign * balance_.gradient(row), force);
    if (!(opening.acceleration > k_leans * opening.by_loads)) return;
    const std::string beyond = is_angle ? degrees_text(depth) : length_text(depth);
    add("starts_beyond_stop", limit.where,
        "'" + limit.name + "' begins " + beyond + " beyond its " + (below > 0.0 ? "lower" : "upper") + " stop, which presses back with " +
            force_text(force, is_angle ? "N m" : "N") + ". " +
            (is_angle || is_axis ? "Stops count from the pose given, not from zero" : "Stops of a distance are that distance itself") +
            ": '" + (below > 0.0 ? "lower" : "upper") + "' was probably meant as " +
            (is_angle ? degrees_text(below > 0.0 ? *limit.lower - depth : *limit.upper + depth) + " or " + (below > 0.0 ? "less" : "more")
                      : length_text(below > 0.0 ? *limit.lower - depth : *limit.upper + depth) + (below > 0.0 ? " or less" : " or more")));
  }

  // Returns true if drives and joints to the ground determine the rotation. Its inertia then affects only their loads, which no criterion
  // limits. With actions the result is false, because they may release drives and joints.
  [[nodiscard]] bool is_driven(const Body& body) const {
    const auto named = std::find_if(system_.bodies.begin(), system_.bodies.end(), [&](const BodyData& b) { return b.name == body.name; });
    if (named == system_.bodies.end() || action_group(system_)) return false;
    const auto index = static_cast<int>(named - system_.bodies.begin());
    MatX held(0, 3);
    for (const RowSpec& row : system_.rows) {
      const bool is_its_own = (row.a == index && row.b == k_ground) || (row.a == k_ground && row.b == index);
      if (!is_its_own || row.next) continue;
      if (is_limited(system_.element_names[static_cast<std::size_t>(row.element)])) return false;
      held.conservativeResize(held.rows() + 1, Eigen::NoChange);
      held.row(held.rows() - 1) = balance_.gradient(row).segment<3>(3 * index - 3).transpose();
    }
    const auto rank = PivotedQr(held, k_typed).rank();
    held.conservativeResize(held.rows() + 1, Eigen::NoChange);
    held.row(held.rows() - 1) = Vec3(0.0, 0.0, 1.0).transpose();
    return PivotedQr(held, k_typed).rank() == rank;
  }
  [[nodiscard]] bool is_limited(const std::string& element) const {
    return std::any_of(loaded_.model.criteria.begin(), loaded_.model.criteria.end(), [&](const Criterion& criterion) {
      return std::any_of(system_.channels.begin(), system_.channels.end(), [&](const Channel& channel) {
        return channel.name.starts_with(element + ".") && matches_pattern(channel.name, criterion.channel);
      });
    });
  }

  // Compares the moment of inertia with that of a plate with the shape of the outline, about the body's centre of gravity.
  void check_inertia(const Body& body) {
    double area = 0.0, moment = 0.0, farthest = 0.0;
    for (std::size_t i = 0; i < body.outline.size(); ++i) {
      const Vec2 p = body.outline[i] - body.cg, q = body.outline[(i + 1) % body.outline.size()] - body.cg;
      const double twice = p.x() * q.y() - p.y() * q.x();
      area += 0.5 * twice;
      moment += twice * (p.squaredNorm() + p.dot(q) + q.squaredNorm()) / 12.0;
      farthest = std::max(farthest, p.squaredNorm());
    }
    if (!(std::abs(area) > k_typed * farthest)) return;
    const double plate = body.mass * moment / area, most = body.mass * farthest;
    const bool is_light = body.inertia < k_light * plate;
    if (!is_light && !(body.inertia > k_heavy * most)) return;
    if (is_driven(body)) return;
    std::string text = "body '" + body.name + "': inertia = " + rounded(body.inertia) +
                       " kg m² does not fit its outline and mass: a plate of that shape and of " + rounded(body.mass) + " kg has " +
                       rounded(plate) + " kg m²" +
                       (is_light ? "" : ", and with all of its mass at the farthest corner " + rounded(most) + " kg m²");
    const double per_mass = body.inertia * body.mass / plate;
    if (per_mass > 0.2 && per_mass < 5.0) text += ". It is about that of 1 kg: was it meant for each kilogram?";
    add("inertia_unlike_outline", body.where, text);
  }

  // Checks the radius of gyration. `reach` is the largest distance of the body's points from its centre, `extent` the size of the scene.
  void check_gyration(const Body& body, double reach, double extent) {
    const double gyration = std::sqrt(body.inertia / body.mass);
    if (!(reach > 0.0) || !(gyration > k_beyond_places * reach) || !(gyration > k_beyond_scene * extent) || is_driven(body)) return;
    add("inertia_beyond_places", body.where,
        "body '" + body.name + "': inertia = " + rounded(body.inertia) + " kg m² and mass = " + rounded(body.mass) +
            " kg make a radius of gyration of " + length_text(gyration) + ", but nothing of it is farther than " + length_text(reach) +
            " from its centre of gravity, and the whole scene is " + length_text(extent) + " wide. Check both");
  }

  const LoadedModel& loaded_;
  const System& system_;
  State start_;
  StartBalance balance_;
  std::vector<ContactAtStart> contacts_;
  std::vector<Finding> found_;
};

} // namespace

std::vector<Finding> start_findings(const LoadedModel& loaded) { return StartFinder(loaded).run(); }

} // namespace steplap
