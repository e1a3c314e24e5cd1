// Finds contradictions between the initial state and other data of the model.
#include "mbd/base/decompositions.h"
#include "mbd/base/name_pattern.h"
#include "mbd/base/portable_math.h"
#include "mbd/dynamics/dynamics.h"
#include "mbd/run/body_reach.h"
#include "mbd/run/findings.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/start_scene.h"
#include "mbd/system/actions.h"
#include "mbd/system/contact_description.h"
#include "mbd/system/own_states.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace steplap {

namespace {

// Largest opening acceleration, relative to that due to loads; contacts that settle under loads stay within a few times of it.
constexpr double k_unanswered = 10.0;
constexpr double k_felt = 0.1;    // least opening acceleration, relative to gravity; smaller ones come from rounded poses or clearance
constexpr double k_through = 0.5; // largest penetration, relative to the depth at which a contact law becomes invalid
// Least moment of inertia, relative to a homogeneous plate with the outline: a tenth of its radius of gyration.
constexpr double k_light = 0.01;
// Change of a state within the run, relative to its scale, above which the machine leaves the equilibrium.
constexpr double k_changes = 1e-3;
// Largest moment of inertia, relative to the largest one possible within the outline (all mass at the farthest corner); outlines are
// approximate.
constexpr double k_heavy = 2.0;
// Largest radius of gyration relative to the farthest point of the body, and to the size of the scene. A flywheel may have only its crank
// pin as a point.
constexpr double k_beyond_places = 10.0, k_beyond_scene = 2.0;

class StartFinder {
public:
  explicit StartFinder(const LoadedModel& loaded) : loaded_(loaded), system_(*loaded.system), scene_(loaded) {}

  std::vector<Finding> run() {
    for (const ContactAtStart& contact : scene_.contacts)
      if (const auto check = loaded_.views->of(*contact.entry->kind).check_contact) check(scene_, contact);
    // For a search for equilibrium the given poses are only a first guess, so they are not checked.
    if (loaded_.model.simulation.initial != "equilibrium") {
      for (const ContactAtStart& contact : scene_.contacts) check_depth(contact);
      for (const ElementEntry& entry : loaded_.model.elements)
        if (const auto check = loaded_.views->of(*entry.kind).check_poses) check(scene_, *entry.element);
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
    return std::move(scene_.found);
  }

private:
  [[nodiscard]] bool springs_apart(const StartBalance::Opening& opening) const {
    return opening.acceleration > k_unanswered * std::max(opening.by_loads, k_felt * system_.gravity.norm());
  }

  // The search for an equilibrium keeps inner states at their initial values. If they change afterwards, the machine leaves the
  // equilibrium.
  void check_states() {
    const std::vector<const OwnState*> states = own_states(loaded_.model);
    const auto* group = states.empty() ? nullptr : own_state_group(system_);
    if (!group) return;
    Dynamics dynamics(system_);
    dynamics.set_state(scene_.start);
    std::vector<double> y(static_cast<std::size_t>(system_.largest_dimension())), dy(y.size());
    dynamics.pack(scene_.start, y.data());
    dynamics.rates(scene_.start.t, y.data(), dy.data());
    for (const OwnStateGroup::ElementData& entry : group->entries) {
      const OwnState& state = *states[static_cast<std::size_t>(entry.place.inner - group->first_inner)];
      const double rate =
          dy[static_cast<std::size_t>(2 * dynamics.coordinate_count() + entry.place.inner)] * entry.place.unit / state.factor();
      const double scale = state.scale.value_or(state.start != 0.0 ? std::abs(state.start) : 1.0);
      if (!(std::abs(rate) * loaded_.model.simulation.end > k_changes * scale)) continue;
      const std::string unit = state.unit.empty() ? "" : " " + state.unit;
      scene_.add("state_leaves_equilibrium", state.where,
                 "state '" + state.name + "' starts at " + three_digits(state.start) + unit + " and changes by " + three_digits(rate) +
                     unit + " per second from there: the machine is at rest with it for a moment only. " +
                     "If it is to stay at rest, give it the start at which its rate is zero");
    }
  }

  void check_depth(const ContactAtStart& contact) {
    const Element& element = *contact.entry->element;
    const double size = size_of_pair(system_, contact.a, contact.b), depth = -contact.gap;
    if (!(contact.force > 0.0) || !(depth > StartScene::k_typed * size)) return;
    const VecX gradient = scene_.balance.gap_gradient(contact.contact);
    if (gradient.size() == 0) return;
    const StartBalance::Opening opening = scene_.balance.opening(gradient);
    const auto most = contact_of(*contact.entry, loaded_.model)->depth_limit;
    const bool is_through = most && depth > k_through * *most;
    if (!is_through && !springs_apart(opening)) return;
    const int body = contact.a != k_ground ? contact.a : contact.b;
    const Vec2 out(gradient[3 * body - 3], gradient[3 * body - 2]);
    std::string text = "'" + element.name + "' begins pressed " + short_length(depth) + " deep, with " + short_force(contact.force);
    text += springs_apart(opening) ? ", and nothing balances that: it springs apart with " + three_digits(opening.acceleration) + " m/s²"
                                   : ": one part is half through the other";
    if (contact_of(*contact.entry, loaded_.model)->is_preloaded)
      text += ". A preload or an interference needs its answer: the other side of the same clamp, or a load";
    else
      text += ". Moved by " + short_length(depth) + " along [" + three_digits(out.x()) + ", " + three_digits(out.y()) + "] '" +
              system_.bodies[body].name + "' would just touch; initial = \"equilibrium\" begins where it rests";
    scene_.add("starts_deep", element.where, text);
  }

  // Returns true if drives and joints to the ground prescribe the rotation of the body. Its inertia then affects only their loads, which no
  // criterion limits. Returns false in models with actions, which may release drives and joints.
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
      held.row(held.rows() - 1) = scene_.balance.gradient(row).segment<3>(3 * index - 3).transpose();
    }
    const auto rank = PivotedQr(held, StartScene::k_typed).rank();
    held.conservativeResize(held.rows() + 1, Eigen::NoChange);
    held.row(held.rows() - 1) = Vec3(0.0, 0.0, 1.0).transpose();
    return PivotedQr(held, StartScene::k_typed).rank() == rank;
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
    if (!(std::abs(area) > StartScene::k_typed * farthest)) return;
    const double plate = body.mass * moment / area, most = body.mass * farthest;
    const bool is_light = body.inertia < k_light * plate;
    if (!is_light && !(body.inertia > k_heavy * most)) return;
    if (is_driven(body)) return;
    std::string text = "body '" + body.name + "': inertia = " + three_digits(body.inertia) +
                       " kg m² does not fit its outline and mass: a plate of that shape and of " + three_digits(body.mass) + " kg has " +
                       three_digits(plate) + " kg m²" +
                       (is_light ? "" : ", and with all of its mass at the farthest corner " + three_digits(most) + " kg m²");
    const double per_mass = body.inertia * body.mass / plate;
    if (per_mass > 0.2 && per_mass < 5.0) text += ". It is about that of 1 kg: was it meant for each kilogram?";
    scene_.add("inertia_unlike_outline", body.where, text);
  }

  // Checks the radius of gyration. `reach`: largest distance of the body's points from its centre, m; `extent`: size of the scene, m.
  void check_gyration(const Body& body, double reach, double extent) {
    const double gyration = std::sqrt(body.inertia / body.mass);
    if (!(reach > 0.0) || !(gyration > k_beyond_places * reach) || !(gyration > k_beyond_scene * extent) || is_driven(body)) return;
    scene_.add("inertia_beyond_places", body.where,
               "body '" + body.name + "': inertia = " + three_digits(body.inertia) + " kg m² and mass = " + three_digits(body.mass) +
                   " kg make a radius of gyration of " + short_length(gyration) + ", but nothing of it is farther than " +
                   short_length(reach) + " from its centre of gravity, and the whole scene is " + short_length(extent) +
                   " wide. Check both");
  }

  const LoadedModel& loaded_;
  const System& system_;
  StartScene scene_;
};

} // namespace

std::vector<Finding> start_findings(const LoadedModel& loaded) { return StartFinder(loaded).run(); }

} // namespace steplap
