#include "tools/steplap/warnings.h"

#include "tools/steplap/far_joints.h"
#include "tools/steplap/seams.h"
#include "tools/steplap/stepped_feet.h"

#include "mbd/analysis/assembly.h"
#include "mbd/events/event_handler.h"
#include "mbd/analysis/freedom.h"
#include "mbd/math/portable_math.h"
#include "mbd/model/signal_network.h"
#include "mbd/model/validate.h"
#include "tools/steplap/text_table.h"
#include "transformer/plausible.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

using Names = std::unordered_set<std::string>;

// Names that fields of elements refer to, by what they refer to.
struct References {
  Names signals, markers, bodies;
};

References references_of(const Model& model) {
  References found;
  const auto use_signals = [&](const FieldTable& fields, const void* object) {
    for (const std::string& name : parts_of(fields, object)) found.signals.insert(name);
  };
  for (const SignalEntry& entry : model.signals) use_signals(entry.kind->fields, entry.definition.get());
  for (const ElementEntry& entry : model.elements) use_signals(entry.kind->fields, entry.element.get());
  for (const ElementEntry& entry : model.elements)
    for (const Field& field : entry.kind->fields.fields()) {
      Names* names = nullptr;
      if (field.type == FieldType::marker) names = &found.markers;
      if (field.type == FieldType::body) names = &found.bodies;
      if (names) names->insert(std::get<std::string>(field.get(entry.element.get())));
      if (field.name == "over" && field.type == FieldType::texts) { // what a rope runs over
        const auto over = std::get<std::vector<std::string>>(field.get(entry.element.get()));
        found.markers.insert(over.begin(), over.end());
      }
    }
  for (const Marker& marker : model.markers)
    if (found.markers.count(marker.name) > 0) found.bodies.insert(marker.body);
  return found;
}

std::string place(const Location& where) {
  return where.line > 0 ? " (line " + std::to_string(where.line) + ")" : "";
}

constexpr std::size_t k_most_names = 8;

// "'a' (force_x), 'b' and 'c'"
std::string list_of(const System& system, const std::vector<SharedReaction>& reactions) {
  std::string text;
  const std::size_t shown = std::min(reactions.size(), k_most_names);
  for (std::size_t i = 0; i < shown; ++i) {
    text += i == 0 ? "'" : i + 1 == reactions.size() ? " and '" : ", '";
    text += system.element_names[reactions[i].element] + "'";
    const char* before = " (";
    for (const std::string& quantity : reactions[i].quantities) {
      text += before + quantity;
      before = ", ";
    }
    if (!reactions[i].quantities.empty()) text += ")";
  }
  return shown < reactions.size()
             ? text + " and " + std::to_string(reactions.size() - shown) + " more"
             : text;
}

// Between two places of one body, or of two that do not move, nothing has an effect (joints and drives refuse it).
void warn_of_idle_elements(const Model& model, std::vector<std::string>& warnings) {
  std::unordered_map<std::string, std::string> body_of; // by marker and body; "" does not move
  body_of["ground"] = "";
  for (const Body& body : model.bodies) body_of[body.name] = body.fixed ? "" : body.name;
  for (const Marker& marker : model.markers)
    if (const auto found = body_of.find(marker.body); found != body_of.end()) body_of[marker.name] = std::string(found->second);
  for (const ElementEntry& entry : model.elements) {
    const auto text_of = [&entry](const char* name) {
      const Field* const field = entry.kind->fields.find(name);
      return field && field->type == FieldType::marker ? std::get<std::string>(field->get(entry.element.get())) : std::string();
    };
    const std::string a = text_of("a"), b = text_of("b");
    const Field* const over = entry.kind->fields.find("over");
    if (a.empty() || b.empty() || body_of.count(a) == 0 || body_of.count(b) == 0 || body_of[a] != body_of[b]) continue;
    if (over && !std::get<std::vector<std::string>>(over->get(entry.element.get())).empty()) continue;
    warnings.push_back(entry.kind->name + " '" + entry.element->name + "'" + place(entry.element->where) + " acts between two places " +
                       (body_of[a].empty() ? "that do not move" : "of '" + body_of[a] + "'") + ": it moves nothing");
  }
}

// Loads that constraints can share in more than one way.
void warn_of_shared_reactions(const System& system, std::vector<std::string>& warnings) {
  const Freedom freedom = count_freedom(system);
  if (!freedom.shared.empty())
    warnings.push_back(
        "the reactions of " + list_of(system, freedom.shared) +
        " are not unique: their constraints depend on each other, and how they share a load is not "
        "determined; the motion is. Reported is the sharing with the least forces");
  if (freedom.shared_sticking.size() > freedom.shared.size())
    warnings.push_back("while all friction sticks the reactions of " +
                       list_of(system, freedom.shared_sticking) +
                       " are not unique: they hold together as long as any way to share the load is "
                       "admissible. Reported is one of those ways, in proportion to the capacities where that will do");
}

// Does a load or a drive that changes with time act at the start, or begin to?
bool is_driven_at_start(const Model& model, const Names& used) {
  SignalNetwork network(model); // some are made of others
  return std::any_of(model.signals.begin(), model.signals.end(), [&](const SignalEntry& entry) {
    if (used.count(entry.definition->name) == 0) return false;
    const Signal* const signal = network.build(entry.definition->name);
    return signal && !signal->is_constant() && (signal->value(0.0) != 0.0 || signal->drive(0.0, DriveLevel::position).rate != 0.0);
  });
}

struct StartingBody {
  int body = 0;
  double acceleration = 0.0; ///< m/s², of its centre of gravity, or of its turning at the radius of gyration
};

// The largest acceleration with which the run begins.
StartingBody fastest_at_start(const System& system, const State& initial) {
  Dynamics dynamics(system);
  EventHandler handler(system, dynamics);
  State state = initial;
  start_drives(system, state);
  const auto limit = std::upper_bound(system.breakpoints.begin(), system.breakpoints.end(), state.t);
  dynamics.set_time_limit(limit == system.breakpoints.end() ? system.drives_end : *limit);
  handler.start(state);
  dynamics.set_state(state);
  std::vector<double> y(static_cast<std::size_t>(system.largest_dimension())), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(state.t, y.data(), dy.data());
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  StartingBody fastest;
  for (int i = 1; i < system.body_count(); ++i) {
    const BodyData& body = system.bodies[i];
    const double* a = &snapshot.acceleration[3 * i];
    const double radius = body.mass > 0.0 ? std::sqrt(body.inertia / body.mass) : 0.0;
    const double size = std::max(portable::hypot(a[0], a[1]), radius * std::abs(a[2]));
    if (size > fastest.acceleration) fastest = {i, size};
  }
  return fastest;
}

} // namespace

std::vector<std::string> warnings_about(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  const References used = references_of(model);
  std::vector<std::string> warnings;
  for (const SignalEntry& entry : model.signals)
    if (used.signals.count(entry.definition->name) == 0)
      warnings.push_back("signal '" + entry.definition->name + "'" +
                         place(entry.definition->where) + " is used by nothing");
  Names body_names;
  for (const Body& body : model.bodies)
    body_names.insert(body.name);
  for (const Marker& marker : model.markers) // a marker named as its body is the reader's own
    if (used.markers.count(marker.name) == 0 && body_names.count(marker.name) == 0 &&
        marker.name != "ground")
      warnings.push_back("marker '" + marker.name + "'" + place(marker.where) +
                         " is used by nothing");
  for (const Body& body : model.bodies)
    if (used.bodies.count(body.name) == 0)
      warnings.push_back("no element is attached to body '" + body.name + "'" + place(body.where));
  const SimulationSettings& s = model.simulation;
  if (s.step && !s.tolerance && !has_fixed_step(s.integrator))
    warnings.push_back("'step' of [simulation] is not used: '" + s.integrator +
                       "' chooses its steps by 'tolerance'; for steps of a fixed size choose \"rk4\"");
  warn_of_idle_elements(model, warnings);
  for (std::string& message : far_joints(loaded)) warnings.push_back(std::move(message));
  for (std::string& message : stepped_feet(loaded)) warnings.push_back(std::move(message));
  for (std::string& message : doubled_corners(loaded)) warnings.push_back(std::move(message));
  for (std::string& message : implausible_cores(model)) warnings.push_back(std::move(message));
  warn_of_shared_reactions(*loaded.system, warnings);
  const Trajectory written(*loaded.system, model.output.channels);
  if (written.channels().empty())
    warnings.push_back(
        "no channel matches 'channels' of [output]: the trajectory will hold the time only");
  for (const std::string& name : loaded.plots_left_out)
    warnings.push_back("plot '" + name + "' is left out: not all of its channels are in 'channels' of [output]");
  return warnings;
}

// At rest, and yet about to move by itself: a pendulum that is let go, or a preload without its answer at the other end.
std::vector<std::string> notes_about(const LoadedModel& loaded) {
  constexpr double k_felt = 1e-3; // of gravity: from there on it is seen beside what drives do to a machine
  constexpr double k_standard_gravity = 9.80665;
  if (loaded.model.simulation.initial == "equilibrium" || is_driven_at_start(loaded.model, references_of(loaded.model).signals)) return {};
  const System& system = *loaded.system;
  const State start = assembled_start(system, loaded.assembled);
  if (std::any_of(start.v.begin(), start.v.end(), [](double v) { return v != 0.0; })) return {};
  StartingBody fastest;
  try {
    fastest = fastest_at_start(system, start);
  } catch (const NumericalFailure&) {
    return {}; // the run will say what is wrong
  }
  const double gravity = system.gravity.norm();
  if (!(fastest.acceleration > k_felt * (gravity > 0.0 ? gravity : k_standard_gravity))) return {};
  return {"the run begins at rest, but not in equilibrium: nothing that changes with time drives it yet, and '" +
          system.bodies[fastest.body].name + "' starts with " + quantity_text(fastest.acceleration, "m/s^2", 1e-3) +
          ". If it is not meant to be let go (a preload may lack its answer at the other end), see steplap equilibrium "
          "or set initial = \"equilibrium\" in [simulation]"};
}

} // namespace steplap
