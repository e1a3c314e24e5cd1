#include "mbd/run/findings.h"

#include "mbd/base/number_text.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/events/event_handler.h"
#include "mbd/model/action.h"
#include "mbd/model/body_builder.h"
#include "mbd/model/formula_fields.h"
#include "mbd/model/signal_network.h"
#include "mbd/model/validate.h"
#include "mbd/rest/assembly.h"
#include "mbd/rest/freedom.h"
#include "mbd/run/acted_loads.h"
#include "mbd/run/action_findings.h"
#include "mbd/run/asked_channels.h"
#include "mbd/run/edges.h"
#include "mbd/run/open_end.h"
#include "mbd/run/plausible_run.h"
#include "mbd/run/plausible_scene.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/start_contacts.h"
#include "mbd/simulation/simulation.h"
#include "mbd/trust/balance.h"
#include "mbd/trust/judgement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace steplap {

namespace {

using Names = std::unordered_set<std::string>;

// Names to which the fields of elements refer, by type of the field.
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
      if (field.name == "over" && field.type == FieldType::texts) { // names of markers over which a rope runs
        const auto over = std::get<std::vector<std::string>>(field.get(entry.element.get()));
        found.markers.insert(over.begin(), over.end());
      }
    }
  for (const ElementEntry& entry : model.elements)
    if (const auto* const action = as_action(*entry.element))
      for (const std::string& step : action->steps) found.signals.insert(action_step(step).value);
  for (const ElementEntry& entry : model.elements)
    for (const std::string& name : names_in_formulas(entry)) {
      found.signals.insert(name);
      if (const std::size_t point = name.rfind('.'); point != std::string::npos) found.markers.insert(name.substr(0, point));
    }
  for (const TableEntry& entry : model.tables) // tables can refer to markers, for example to the position of a recorder
    for (const Field& field : entry.kind->fields.fields())
      if (field.type == FieldType::marker) found.markers.insert(std::get<std::string>(field.get(entry.table.get())));
  for (const Marker& marker : model.markers)
    if (found.markers.count(marker.name) > 0) found.bodies.insert(marker.body);
  return found;
}

using Findings = std::vector<Finding>;

void warn(Findings& findings, const char* code, std::string text, const Location& where = {}) {
  findings.push_back({code, FindingLevel::warning, std::move(text), where});
}

constexpr std::size_t k_most_names = 8;

// Returns "'a' (force_x), 'b' and 'c'".
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
  return shown < reactions.size() ? text + " and " + std::to_string(reactions.size() - shown) + " more" : text;
}

// Finds elements without effect, because they act between two points of one body or of two fixed bodies. Joints and drives report this
// themselves.
void warn_of_idle_elements(const Model& model, Findings& findings) {
  std::unordered_map<std::string, std::string> body_of; // moving body of each marker and body; "" if it is fixed
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
    warn(findings, "idle_element",
         entry.kind->name + " '" + entry.element->name + "' acts between two places " +
             (body_of[a].empty() ? "that do not move" : "of '" + body_of[a] + "'") + ": it moves nothing",
         entry.element->where);
  }
}

// Finds parameters that are used nowhere, perhaps because the name is misspelt where it should be used.
void warn_of_unused_parameters(const Model& model, Findings& findings) {
  const Parameters& parameters = model.parameters;
  Names in_formulas; // names in formulas of forces and states
  for (const ElementEntry& entry : model.elements)
    for (const std::string& name : names_in_formulas(entry)) in_formulas.insert(name);
  for (std::size_t i = 0; i < parameters.entries.size(); ++i) {
    const Parameter& parameter = parameters.entries[i];
    const auto needs_it = [&](const ParameterFormula& formula) {
      return std::find(formula.of.begin(), formula.of.end(), i) != formula.of.end();
    };
    const bool is_used =
        in_formulas.count(parameter.name) > 0 ||
        std::any_of(parameters.uses.begin(), parameters.uses.end(), [&](const ParameterUse& use) { return needs_it(use.formula); }) ||
        std::any_of(parameters.entries.begin(), parameters.entries.end(),
                    [&](const Parameter& p) { return p.formula && needs_it(*p.formula); });
    if (!is_used) warn(findings, "unused_parameter", "nothing follows from parameter '" + parameter.name + "'", parameter.where);
  }
}

// Finds loads whose distribution among redundant constraints is not unique.
void warn_of_shared_reactions(const System& system, Findings& findings) {
  const DegreesOfFreedom freedom = count_freedom(system);
  if (!freedom.shared.empty())
    warn(findings, "shared_reactions",
         "the reactions of " + list_of(system, freedom.shared) +
             " are not unique: their constraints depend on each other, and how they share a load is not "
             "determined; the motion is. Reported is the sharing with the least forces");
  if (freedom.shared_sticking.size() > freedom.shared.size())
    warn(findings, "shared_friction",
         "while all friction sticks the reactions of " + list_of(system, freedom.shared_sticking) +
             " are not unique: they hold together as long as any way to share the load is "
             "admissible. Reported is one of those ways, in proportion to the capacities where that will do");
}

// Returns true if a load or drive that varies with time acts at the start.
bool is_driven_at_start(const Model& model, const Names& used) {
  SignalNetwork network(model); // signals can be composed of others
  return std::any_of(model.signals.begin(), model.signals.end(), [&](const SignalEntry& entry) {
    if (used.count(entry.definition->name) == 0) return false;
    const Signal* const signal = network.build(entry.definition->name);
    return signal && !signal->is_constant() && (signal->value(0.0) != 0.0 || signal->drive(0.0, DriveLevel::position).rate != 0.0);
  });
}

// Initial accelerations of the bodies, and contact forces at the start.
struct Start {
  /// Per body, m/s²: acceleration of the centre of gravity, or angular acceleration times radius of gyration.
  std::vector<double> acceleration;
  std::vector<ContactAtStart> contacts;
  std::vector<PairJacobian> springs;
};

Start start_of(const LoadedModel& loaded, const State& initial) {
  const System& system = *loaded.system;
  Dynamics dynamics(system);
  EventHandler handler(system, dynamics);
  State state = initial;
  start_drives(system, state);
  const auto limit = std::upper_bound(system.breakpoints.begin(), system.breakpoints.end(), state.t);
  dynamics.set_left_limit_time(limit == system.breakpoints.end() ? system.drives_end : *limit);
  handler.start(state);
  dynamics.set_state(state);
  std::vector<double> y(static_cast<std::size_t>(system.largest_dimension())), dy(y.size());
  dynamics.pack(state, y.data());
  dynamics.rates(state.t, y.data(), dy.data());
  const Snapshot snapshot = dynamics.snapshot(dy.data());
  Start start;
  for (int i = 0; i < system.body_count(); ++i) {
    const BodyData& body = system.bodies[i];
    const double* a = &snapshot.acceleration[3 * i];
    const double radius = body.mass > 0.0 ? std::sqrt(body.inertia / body.mass) : 0.0;
    start.acceleration.push_back(std::max(portable::hypot(a[0], a[1]), radius * std::abs(a[2])));
  }
  start.contacts = contacts_at(loaded, initial);
  for (const auto& group : system.groups) group->add_jacobian(dynamics.evaluation(), start.springs);
  return start;
}

std::string short_number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

constexpr double k_near = 0.5;     // largest distance to a contact, in body sizes; a body at a greater height is dropped intentionally
constexpr double k_settles = 1e-3; // largest deflection, in body sizes, that counts as settling under load

// Returns the cause of a body's acceleration at the start as text: nearby contacts that do not carry it, or springs that are not balanced.
// Returns "" if the motion is probably intended: bodies guided by joints are released, bodies higher than half their size are dropped,
// bodies on contacts settle.
std::string cause_of(const System& system, const Start& start, int body) {
  const double size = size_of_pair(system, body, k_ground);
  const ContactAtStart* nearest = nullptr;
  for (const ContactAtStart& contact : start.contacts)
    if ((contact.a == body || contact.b == body) && (!nearest || contact.gap < nearest->gap)) nearest = &contact;
  if (nearest && nearest->gap <= k_settles * size) return "";
  if (nearest && nearest->gap <= k_near * size)
    return "no contact carries it, the nearest, '" + nearest->entry->element->name + "', is " + quantity_text(nearest->gap, "m", 1e-3) +
           " away. If that is not meant, check its gaps";
  double stiffness = 0.0;
  for (const PairJacobian& part : start.springs) {
    if (part.contact >= 0 || (part.a != body && part.b != body)) continue;
    const Eigen::Matrix3d own = part.a == body ? part.stiffness.topLeftCorner<3, 3>() : part.stiffness.bottomRightCorner<3, 3>();
    stiffness = std::max({stiffness, std::abs(own(0, 0)), std::abs(own(1, 1)), std::abs(own(2, 2)) / (size * size)});
  }
  const double gives = stiffness > 0.0 ? system.bodies[body].mass * start.acceleration[static_cast<std::size_t>(body)] / stiffness : 0.0;
  if (!(gives > k_settles * size)) return "";
  return "the springs on it do not balance its loads. If that is not meant, check their preloads (one may lack its answer at the other "
         "end)";
}

// Finds bodies at rest that begin to move although something near should hold them.
void note_restless_start(const LoadedModel& loaded, Findings& findings) {
  constexpr double k_felt = 1e-3; // acceleration, relative to gravity, above which a motion is noticeable next to those due to drives
  if (loaded.model.simulation.initial == "equilibrium" || is_driven_at_start(loaded.model, references_of(loaded.model).signals)) return;
  const System& system = *loaded.system;
  const State initial = assembled_start(system, loaded.assembled);
  if (std::any_of(initial.v.begin(), initial.v.end(), [](double v) { return v != 0.0; })) return;
  Start start;
  try {
    start = start_of(loaded, initial);
  } catch (const NumericalFailure&) {
    return; // the run reports the error
  }
  int worst = -1;
  std::string cause;
  for (int i = 1; i < system.body_count(); ++i) {
    const double own = start.acceleration[static_cast<std::size_t>(i)];
    if (!(own > k_felt * system.gravity.norm()) || !(own > 0.0) ||
        (worst >= 0 && own <= start.acceleration[static_cast<std::size_t>(worst)]))
      continue;
    if (std::string text = cause_of(system, start, i); !text.empty()) {
      worst = i;
      cause = std::move(text);
    }
  }
  if (worst < 0) return;
  const std::string& name = system.bodies[worst].name;
  const Body* const body = loaded.model.find_body(name);
  findings.push_back({"restless_start", FindingLevel::note,
                      "At t = 0 '" + name + "' accelerates at " + short_number(start.acceleration[static_cast<std::size_t>(worst)]) +
                          " m/s²: " + cause + ", or use initial = \"equilibrium\"",
                      body ? body->where : Location{}});
}

void warn_of_restricted_extremes(const LoadedModel& loaded, Findings& findings) {
  const AskedChannels asked(loaded.model, *loaded.system);
  const std::vector<Channel>& channels = loaded.system->channels;
  const auto left_out = std::count_if(channels.begin(), channels.end(), [&asked](const Channel& c) { return asked.leave_out(c); });
  if (left_out == 0) return;
  warn(findings, "extremes_left_out",
       "of " + std::to_string(channels.size()) + " channels, extremes of " + std::to_string(left_out) +
           " are left out, since no [[plot]] and no list of [output] names them: channels = [\"*\"] asks for all",
       loaded.model.output.where);
}

// Returns true if a table created the body. The free ends of such bodies (beams) are intended.
bool is_made_by_table(const Model& model, const std::string& name) {
  return std::any_of(model.tables.begin(), model.tables.end(),
                     [&](const TableEntry& e) { return body_builder(e) && name.starts_with(e.table->name + "."); });
}

void warn_of_renamed_keys(const Model& model, Findings& findings) {
  for (const RenamedKey& key : model.renamed_keys)
    warn(findings, "renamed_key",
         "'" + key.earlier + "' of " + key.subject + " is now called '" + key.name + "': the next minor version refuses the earlier name",
         key.where);
}

// Finds unused signals and markers, only in the file that is run: a file that it extends or includes as a part may offer more than one
// model needs.
void warn_of_unused(const Model& model, Findings& findings) {
  const References used = references_of(model);
  const auto is_inherited = [&](const Location& where) { return where.file != model.header.where.file; };
  for (const SignalEntry& entry : model.signals)
    if (used.signals.count(entry.definition->name) == 0 && !is_inherited(entry.definition->where))
      warn(findings, "unused_signal", "signal '" + entry.definition->name + "' is used by nothing", entry.definition->where);
  Names body_names;
  for (const Body& body : model.bodies) body_names.insert(body.name);
  for (const Marker& marker : model.markers) // a marker with the name of its body was created by the reader, not by the user
    if (used.markers.count(marker.name) == 0 && body_names.count(marker.name) == 0 && marker.name != "ground" &&
        !is_made_by_table(model, marker.name) && !is_inherited(marker.where))
      warn(findings, "unused_marker", "marker '" + marker.name + "' is used by nothing", marker.where);
  for (const Body& body : model.bodies)
    if (used.bodies.count(body.name) == 0) warn(findings, "loose_body", "no element is attached to body '" + body.name + "'", body.where);
}

void append(Findings& findings, Findings more) {
  findings.insert(findings.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

} // namespace

std::vector<Finding> implausible_findings(const LoadedModel& loaded) {
  Findings findings;
  for (const auto check : loaded.views->value_checks) append(findings, check(loaded.model));
  append(findings, implausible_friction(loaded));
  append(findings, implausible_gravity(loaded));
  append(findings, implausible_loads(loaded));
  append(findings, magnitude_warnings(loaded));
  return findings;
}

namespace {

// Finds given poses that assembly changed noticeably. Digits lost in the file, and velocities set by drives or joints, are not reported.
std::optional<Finding> note_of_moves(const LoadedModel& loaded) {
  constexpr double k_noticeable = 1e-5; // displacement, m, or rotation, rad
  const System& system = *loaded.system;
  auto moves = assembly_moves(system.initial_state(), loaded.assembled, k_noticeable);
  std::erase_if(moves, [](const AssemblyMove& m) { return m.shift <= k_noticeable && std::abs(m.turn) <= k_noticeable; });
  if (moves.empty()) return std::nullopt;
  return Finding{"assembly_moved",
                 FindingLevel::note,
                 "assembling the joints moved " + counted(moves.size(), "body", "bodies") + ", most of all '" +
                     system.bodies[moves.front().body].name + "' by " + quantity_text(moves.front().shift, "m", 1e-3) + " and " +
                     quantity_text(moves.front().turn, "rad", 1e-3) + "; steplap check lists them",
                 {}};
}

// Finds the initial velocity, linear or angular, given for a body, of which assembly changed the largest share. The common velocity of
// [simulation] is not meant for bodies that joints hold.
std::optional<Finding> changed_velocity(const LoadedModel& loaded) {
  constexpr double k_changed = 1e-2; // share; digits lost in the file are less
  const System& system = *loaded.system;
  const std::vector<double>&given = system.initial_state().v, &now = loaded.assembled.v;
  std::optional<Finding> found;
  double most = k_changed;
  const std::vector<Body>& bodies = loaded.model.bodies;
  auto body = bodies.begin();
  for (int i = 1; i < system.body_count(); ++i) { // the system has the movable bodies in the order of the model
    const std::size_t k = 3 * static_cast<std::size_t>(i);
    body = std::find_if(body, bodies.end(), [&](const Body& b) { return b.name == system.bodies[i].name; });
    if (body == bodies.end()) break;
    const auto look = [&](double size, double change, const char* what, double size_now, const char* unit) {
      if (!(change > most * size)) return;
      most = change / size;
      found = Finding{"velocity_changed", FindingLevel::warning,
                      "the joints do not permit the " + std::string(what) + " of " + quantity_text(size, unit) + " that '" + body->name +
                          "' is given at the start, and change it to " + quantity_text(size_now, unit, size) +
                          ": give all bodies of a mechanism velocities that fit its joints",
                      body->where};
    };
    if (body->velocity != Vec2::Zero())
      look(portable::hypot(given[k], given[k + 1]), portable::hypot(now[k] - given[k], now[k + 1] - given[k + 1]), "velocity",
           portable::hypot(now[k], now[k + 1]), "m/s");
    if (body->angular_velocity != 0.0)
      look(std::abs(given[k + 2]), std::abs(now[k + 2] - given[k + 2]), "angular velocity", std::abs(now[k + 2]), "rad/s");
  }
  return found;
}

} // namespace

std::vector<Finding> findings_before(const LoadedModel& loaded) {
  Findings findings;
  for (const auto check : loaded.views->scene_checks) append(findings, check(loaded));
  append(findings, start_findings(loaded));
  append(findings, implausible_findings(loaded));
  append(findings, idle_actions(loaded));
  append(findings, pulses_at_rest(loaded));
  if (const std::optional<Finding> changed = changed_velocity(loaded)) findings.push_back(*changed);
  if (const std::optional<Finding> moved = note_of_moves(loaded)) {
    findings.push_back(*moved);
    for (const auto check : loaded.views->assembly_checks) append(findings, check(loaded));
  }
  return findings;
}

// Returns a note if steps were divided because a body rotated too far within one step. All legs of a run have the bodies of the
// model in the same order.
static std::optional<Finding> divided_steps(const LoadedModel& loaded, const DividedSteps& divided) {
  if (divided.count == 0) return std::nullopt;
  const auto name = [&](int body) {
    return body == k_ground ? "the ground" : "'" + loaded.system->bodies[static_cast<std::size_t>(body)].name + "'";
  };
  Finding finding;
  finding.code = "steps_divided";
  finding.level = FindingLevel::note;
  finding.text = std::to_string(divided.count) + (divided.count == 1 ? " step of '" : " steps of '") + loaded.model.simulation.integrator +
                 (divided.count == 1 ? "' was" : "' were") + " divided, down to " + rounded_text(divided.shortest, 3) +
                 " s: " + name(divided.a) + " turns against " + name(divided.b) +
                 ", and within one step it may turn by 1 rad at most and pass no point of a curve over its angle";
  return finding;
}

static std::optional<Finding> tolerance_below_rounding(const LoadedModel& loaded, double rounded) {
  const double used = options_of(loaded.model).settings.tolerance, asked = loaded.model.simulation.tolerance.value_or(used);
  const bool is_raised = asked < used && !has_fixed_step(loaded.model.simulation.integrator);
  if (rounded == 0.0 && !is_raised) return std::nullopt;
  Finding finding;
  finding.code = "tolerance_below_rounding";
  finding.level = FindingLevel::note;
  finding.text = "tolerance = " + number_text(asked) + " lies below rounding";
  if (is_raised) finding.text += ", and is taken as " + number_text(used);
  if (rounded > 0.0)
    finding.text += ": the forces of stiff elements are known no better than their stiffness times the rounding of places, and steps are "
                    "controlled to " +
                    rounded_text(rounded, 2) + " there";
  finding.text += ". A smaller tolerance makes a run no more accurate";
  return finding;
}

std::vector<Finding> findings_after(const LoadedModel& loaded, const RunResult& result) {
  Findings findings = contacts_beyond_edges(loaded, result);
  for (const ChannelRange& range : result.ranges)
    if (range.channel->is_on_request && range.had_no_value)
      warn(findings, "channel_without_value",
           "channel '" + range.channel->name +
               "' had no value at some time (a division by zero, a root of what is negative): its extremes are of the other times");
  append(findings, contacts_too_deep(loaded, result.ranges));
  append(findings, parts_outside(loaded, result));
  if (const std::optional<Finding> divided = divided_steps(loaded, result.statistics.divided_steps)) findings.push_back(*divided);
  if (const std::optional<Finding> rounded = tolerance_below_rounding(loaded, result.statistics.rounded_tolerance))
    findings.push_back(*rounded);
  append(findings, actions_that_wait(loaded, result));
  return findings;
}

bool is_judged(const Model& model) {
  return !model.criteria.empty() ||
         std::any_of(model.elements.begin(), model.elements.end(), [](const ElementEntry& entry) { return entry.kind->judge != nullptr; });
}

std::vector<Finding> findings_at_end(const LoadedModel& loaded, const RunResult& result, const Judgement& judgement) {
  if (result.ranges.empty() || !judgement.has_criteria) return {}; // extremes were not computed, or nothing is judged
  Findings findings = loads_not_acted(loaded, result, judgement);
  append(findings, growing_criteria(loaded, result, judgement));
  append(findings, bodies_that_fall(loaded, result));
  append(findings, open_at_end(loaded, result));
  append(findings, distant_limit_findings(loaded, result, judgement));
  return findings;
}

Finding balance_finding(const LoadedModel& loaded, const UnstableBody& balance) {
  const double tenfold = std::numbers::ln10 / balance.rate;
  const double degrees = balance.direction * 180.0 / std::numbers::pi;
  const std::string way = balance.coordinate == 2 ? "turns" : "moves at " + rounded_text(std::round(degrees) + 0.0, 3) + "° to the x axis";
  Finding finding;
  finding.code = "balances";
  finding.text = "'" + balance.body + "' stays where it is only because nothing disturbs it: from t = " + rounded_text(balance.t, 3) +
                 " s on it " + way + " when it is nudged, ten times further every " + rounded_text(tenfold, 3) +
                 " s. Nothing real is so exact: give it what it has, a slant, an offset, a load from the side";
  for (const Body& body : loaded.model.bodies)
    if (body.name == balance.body) finding.where = body.where;
  return finding;
}

Finding balance_unknown_finding(const std::string& why) {
  return {
      "balance_unknown", FindingLevel::note, "whether what stays where it is would do so if it were nudged was not found out: " + why, {}};
}

std::vector<Finding> findings_of(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  Findings findings;
  append(findings, start_findings(loaded));
  warn_of_renamed_keys(model, findings);
  warn_of_unused(model, findings);
  const SimulationSettings& s = model.simulation;
  if (s.step && !s.tolerance && !has_fixed_step(s.integrator))
    warn(findings, "unused_step",
         "'step' of [simulation] is not used: '" + s.integrator +
             "' chooses its steps by 'tolerance'; for steps of a fixed size choose \"rk4\"",
         s.where);
  warn_of_unused_parameters(model, findings);
  warn_of_idle_elements(model, findings);
  append(findings, idle_actions(loaded));
  append(findings, pulses_at_rest(loaded));
  for (const auto check : loaded.views->assembly_checks) append(findings, check(loaded));
  for (const auto check : loaded.views->scene_checks) append(findings, check(loaded));
  append(findings, implausible_findings(loaded));
  append(findings, start_slides(loaded));
  if (is_judged(model)) append(findings, loads_beyond_end(loaded));
  warn_of_shared_reactions(*loaded.system, findings);
  const Trajectory written(*loaded.system, model.output.channels);
  if (written.channels().empty())
    warn(findings, "no_channel", "no channel matches 'channels' of [output]: the trajectory will hold the time only", model.output.where);
  for (const std::string& name : loaded.plots_left_out)
    warn(findings, "plot_left_out", "plot '" + name + "' is left out: not all of its channels are in 'channels' of [output]");
  warn_of_restricted_extremes(loaded, findings);
  note_restless_start(loaded, findings);
  return findings;
}

} // namespace steplap
