#include "elements/views/friction_plane.h"

#include "elements/coulomb_friction.h"
#include "elements/coulomb_stick.h"
#include "elements/polygon_contact.h"
#include "mbd/base/event_kind.h"
#include "mbd/base/portable_math.h"
#include "mbd/model/entries.h"
#include "mbd/run/quantity_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace steplap {

namespace {

constexpr double k_one_line = 1e-6;     // tolerance for the direction of contacts whose friction is summed
constexpr double k_same_load = 0.02;    // tolerance for normal forces of one contact in two independent models
constexpr double k_same_gravity = 1e-6; // tolerance for the magnitude of gravity
// Transverse component, relative to mu N, below which one plane decides alone: it reduces the capacity by less than 0.1 %.
constexpr double k_part_of_other = 0.05;

const CoulombFriction* friction_of(const System& system, const std::string& element) {
  for (const FrictionUnit& unit : system.frictions)
    if (system.element_names[unit.element] == element) return dynamic_cast<const CoulombFriction*>(unit.friction.get());
  return nullptr;
}

// Returns the normal of the contacts of a friction; zero for a wheel or a removed element. An outline may touch with any of its faces; the
// most level face carries the load.
Vec2 normal_of(const System& system, const std::string& element, const Vec2& gravity) {
  const CoulombFriction* const friction = friction_of(system, element);
  Vec2 best = Vec2::Zero();
  if (!friction) return best;
  for (const RowSpec& foot : friction->feet) {
    if (foot.kind != MeasureKind::slide) continue;
    const Vec2 normal = rotated(foot.direction, system.bodies[foot.b].pose.z());
    if (best == Vec2::Zero() || gravity.dot(normal) < gravity.dot(best)) best = normal;
  }
  return best;
}

bool has_opened(const Model& whole, const RunResult& result, const std::string& element) {
  std::vector<std::string> contacts{element};
  for (const CoulombStick* const stick : elements_of<CoulombStick>(whole))
    if (stick->name == element) contacts = stick->contacts;
  return std::any_of(result.events.begin(), result.events.end(), [&](const Event& event) {
    return event.kind == EventKind::opens && std::find(contacts.begin(), contacts.end(), event.element) != contacts.end();
  });
}

template <class T> T last_or(const std::vector<T>& values, std::size_t i) { return values[std::min(i, values.size() - 1)]; }

} // namespace

FrictionNames friction_names(const Model& model) {
  FrictionNames names;
  for (const CoulombStick* const stick : elements_of<CoulombStick>(model))
    names[stick->shared_friction.empty() ? stick->name : stick->shared_friction].push_back(stick->name);
  for (const PolygonContact* const contact : elements_of<PolygonContact>(model))
    if (contact->static_friction) names[contact->name].push_back(contact->name);
  return names;
}

std::optional<FrictionPlane> friction_plane(const System& system, const std::string& friction, const std::vector<std::string>& elements,
                                            const Vec2& gravity, const std::string& file) {
  const Vec2 normal = normal_of(system, elements.front(), gravity);
  if (normal == Vec2::Zero()) return {};
  for (const std::string& element : elements)
    if ((normal_of(system, element, gravity) - normal).norm() > k_one_line)
      throw ModelError({file, 0, 0}, "'" + elements.front() + "' and '" + element + "' are one friction, '" + friction +
                                         "', for models of other planes, and act along different lines: give one of them a "
                                         "'shared_friction' of its own");
  FrictionPlane plane;
  plane.tangent = Vec2(normal.y(), -normal.x());
  plane.gravity = gravity.norm();
  plane.downhill = gravity.dot(plane.tangent);
  plane.tilt = plane.gravity > 0.0 ? -gravity.dot(normal) / plane.gravity : 1.0;
  return plane;
}

// --- traces -----------------------------------------------------------------------------------------

std::vector<std::string> traced_channels(const std::vector<std::string>& elements) {
  std::vector<std::string> channels;
  for (const std::string& element : elements)
    for (const char* const name : {".friction", ".capacity", ".mode"}) channels.push_back(element + name);
  return channels;
}

std::vector<SampledFriction> friction_traces(const Model& whole, const System& system, const RunResult& result,
                                             const std::vector<std::string>& elements, double begin, double step) {
  std::vector<SampledFriction> traces;
  const Trajectory& rows = *result.trajectory;
  for (const std::string& element : elements) {
    SampledFriction trace;
    trace.step = step;
    trace.lifts = has_opened(whole, result, element);
    if (const CoulombFriction* const friction = friction_of(system, element))
      trace.mu_static = friction->mu_static, trace.mu_kinetic = friction->mu_kinetic;
    const std::size_t force = rows.column(element + ".friction"), capacity = rows.column(element + ".capacity"),
                      mode = rows.column(element + ".mode");
    // The first row may not be at 0 if the run did not begin there; rows are at multiples of the step on their own time axis.
    constexpr double k_hair = 1e-6; // tolerance of times, relative to the step
    for (std::size_t i = 0, k = 0; i < rows.size(); ++k) {
      const double t = begin + static_cast<double>(k) * step;
      while (i + 1 < rows.size() && rows.time(i + 1) <= t + k_hair * step) ++i;
      const bool is_last = i + 1 == rows.size();
      if (is_last && rows.time(i) < t - k_hair * step) break;
      const double share = is_last ? 0.0 : std::clamp((t - rows.time(i)) / (rows.time(i + 1) - rows.time(i)), 0.0, 1.0);
      const auto at = [&](std::size_t column) {
        const double value = rows.value(i, column);
        return share > 0.0 ? value + share * (rows.value(i + 1, column) - value) : value;
      };
      trace.force.push_back(at(force));
      trace.normal.push_back(trace.mu_static > 0.0 ? std::max(0.0, at(capacity)) / trace.mu_static : 0.0);
      trace.sticks.push_back(static_cast<FrictionPhase>(static_cast<int>(rows.value(i, mode))) == FrictionPhase::stick ? 1 : 0);
      if (is_last) break;
    }
    traces.push_back(std::move(trace));
  }
  return traces;
}

SampledFriction sum_of_traces(const std::vector<SampledFriction>& traces) {
  SampledFriction sum = traces.front();
  for (std::size_t k = 1; k < traces.size(); ++k) {
    const SampledFriction& more = traces[k];
    sum.lifts |= more.lifts;
    sum.mu_static = std::min(sum.mu_static, more.mu_static);
    sum.mu_kinetic = std::min(sum.mu_kinetic, more.mu_kinetic);
    for (std::size_t i = 0; i < sum.force.size(); ++i) {
      sum.force[i] += last_or(more.force, i);
      sum.normal[i] += last_or(more.normal, i);
      sum.sticks[i] = sum.sticks[i] != 0 && last_or(more.sticks, i) != 0 ? 1 : 0;
    }
  }
  return sum;
}

// --- both planes ------------------------------------------------------------------------------------

std::string SharedContact::disagreement() const {
  const FrictionPlane &a = *planes[0], &b = *planes[1];
  if (std::abs(a.gravity - b.gravity) > k_same_gravity * std::max(a.gravity, b.gravity))
    return "gravity is " + quantity_text(a.gravity, "m/s^2") + " in '" + a.model_name + "' and " + quantity_text(b.gravity, "m/s^2") +
           " in '" + b.model_name + "', which share the friction '" + name +
           "': tilt gravity in each plane by the slope of that plane, and leave its size";
  constexpr double k_level = 1.0 - 1e-9; // cosine above which a tilt is rounding
  if (at_rest[0] == 0.0 && at_rest[1] == 0.0 && std::min(a.tilt, b.tilt) < k_level)
    return "the friction '" + name + "' carries nothing at the start, so what the slope takes from its load is not known: begin at rest";
  const double first = at_rest[0] / a.tilt, second = at_rest[1] / b.tilt;
  if (std::abs(first - second) > k_same_load * std::max(first, second))
    return "the friction '" + name + "' carries " + quantity_text(first, "N") + " at rest in '" + a.model_name + "' and " +
           quantity_text(second, "N") + " in '" + b.model_name +
           "': make the models agree, or give two different frictions different names, or, of a coulomb_stick, another 'shared_friction'";
  return "";
}

double SharedContact::normal(const std::array<SampledFriction, 2>& traces, std::size_t k) const {
  const double first = planes[0]->tilt, second = planes[1]->tilt;
  const double both = std::sqrt(std::max(0.0, first * first + second * second - 1.0));
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < 2; ++p) {
    const double tilt = planes[p]->tilt, lost = tilt > 0.0 ? at_rest[p] * (1.0 - both / tilt) : 0.0;
    least = std::min(least, std::max(0.0, last_or(traces[p].normal, k) - lost));
  }
  return least;
}

SharedUse shared_use(const SharedContact& contact, const std::array<SampledFriction, 2>& traces) {
  // Relative to the load at rest: a lower normal force counts as unloaded; relative to mu N: from here on both planes slip together.
  constexpr double k_unloaded = 1e-6, k_full = 1.0 - 1e-9;
  const double mu = std::min(traces[0].mu_static, traces[1].mu_static);
  SharedUse found;
  double before = 0.0;
  bool is_last_largest = false;
  for (std::size_t k = 0; k < std::max(traces[0].force.size(), traces[1].force.size()); ++k) {
    const double normal = contact.normal(traces, k), capacity = mu * normal;
    if (!(normal > k_unloaded * contact.at_rest[0]) || !(capacity > 0.0)) continue;
    const std::array<double, 2> force{last_or(traces[0].force, k), last_or(traces[1].force, k)};
    const double use = portable::hypot(force[0], force[1]) / capacity;
    if (is_last_largest) found.error = std::max(found.error, before - use);
    is_last_largest = use > found.use;
    if (is_last_largest) found = {use, capacity, static_cast<double>(k) * traces[0].step, k > 0 ? use - before : 0.0, found.slips};
    before = use;
    const bool is_alone = (last_or(traces[0].sticks, k) == 0 && force[0] != 0.0) || (last_or(traces[1].sticks, k) == 0 && force[1] != 0.0);
    found.slips |= (use >= k_full || is_alone) && std::min(std::abs(force[0]), std::abs(force[1])) >= k_part_of_other * capacity;
  }
  return found;
}

} // namespace steplap
