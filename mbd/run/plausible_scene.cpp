#include "mbd/run/plausible_scene.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/load_case.h"
#include "mbd/io/record_signal.h"
#include "mbd/model/action.h"
#include "mbd/model/signal_network.h"
#include "mbd/run/acting_signals.h"
#include "mbd/run/late_formulas.h"
#include "mbd/run/loaded_model.h"
#include "mbd/run/model_entries.h"
#include "mbd/system/actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <unordered_set>

namespace steplap {

namespace {

// Implausible positions and velocities, larger than in any transport. Positions of 1e6 m have a resolution of 0.2 nm, which is still
// negligible.
constexpr double k_far = 1e6;  // largest plausible coordinate, m
constexpr double k_fast = 1e4; // largest plausible velocity, m/s
// Largest plausible ratio between values of a kind. Numbers have sixteen digits, so beyond this ratio fewer than four digits of the smaller
// one are significant.
constexpr double k_apart = 1e12;

// Coefficients of dry friction. Contacts of machines have 0.1 to 0.8, rubber 0.9 and more, clean metals in air up to 1.1.
constexpr double k_high_friction = 0.8, k_implausible_friction = 1.2;
constexpr double k_whole_turn = 2.0 * std::numbers::pi; // largest plausible angle, rad

Finding warning(const char* code, std::string text, const Location& where) { return {code, FindingLevel::warning, std::move(text), where}; }

// Returns true if the signal and its derivatives are zero at every breakpoint and between.
bool is_zero(const Signal& signal, double end) {
  std::vector<double> times = {0.0, end};
  for (const double t : signal.breakpoints())
    if (t > 0.0 && t < end) times.push_back(t);
  std::sort(times.begin(), times.end());
  // a piece between breakpoints is a polynomial plus a few harmonics; with so many zeros it is zero everywhere
  constexpr int k_samples = 16;
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    for (int k = 0; k <= k_samples; ++k)
      if (signal.value(times[i] + (times[i + 1] - times[i]) * (k + 0.37) / (k_samples + 1.0)) != 0.0) return false;
  return true;
}

// Returns the signals that elements name, in their fields, formulas and actions.
std::unordered_set<std::string> used_signals(const Model& model) {
  std::unordered_set<std::string> used;
  for (const ActingSignal& use : acting_signals_without_actions(model, model.simulation.end)) used.insert(use.signal);
  for (const ElementEntry& entry : model.elements)
    if (const auto* const action = as_action(*entry.element))
      for (const std::string& step : action->steps) used.insert(action_step(step).value);
  return used;
}

bool is_part(const Model& model, const std::string& name) {
  return std::any_of(model.signals.begin(), model.signals.end(), [&name](const SignalEntry& entry) {
    const std::vector<std::string> parts = parts_of(entry.kind->fields, entry.definition.get());
    return std::find(parts.begin(), parts.end(), name) != parts.end();
  });
}

// Returns the first signal of the model's own file that varies and that nothing uses, if nothing else loads the machine: no constant load,
// no drive, no formula of the time and no action. A machine under another load may have spare signals.
const SignalEntry* idle_load(const Model& model, const std::unordered_set<std::string>& used, SignalNetwork& network) {
  const auto is_load = [](const ElementEntry& entry) {
    return as_action(*entry.element) || uses_time(entry) ||
           (entry.kind->has_constant_load && entry.kind->has_constant_load(*entry.element));
  };
  if (model.simulation.velocity != Vec2::Zero() || std::any_of(model.elements.begin(), model.elements.end(), is_load)) return nullptr;
  const SignalEntry* idle = nullptr;
  for (const SignalEntry& entry : model.signals) {
    const std::string& name = entry.definition->name;
    const Signal* const signal = network.build(name);
    if (!signal || signal->is_constant()) {
      if (signal && signal->value(0.0) != 0.0 && used.contains(name)) return nullptr;
    } else if (!idle && !used.contains(name) && !is_part(model, name) && entry.definition->where.file == model.header.where.file) {
      idle = &entry;
    }
  }
  return idle;
}

// Returns the first interval, s, in which rows of a record are missing; nothing if the rows are not evenly spaced apart from few
// exceptions. A row is missing if a time step is at least 1.5 times the usual one; usual steps may differ by a tenth, because times are
// written with few digits. Gaps with equal values on both sides are ignored, because recorders may omit repeated values.
std::optional<std::pair<double, double>> missing_rows(const Signal& signal) {
  constexpr double k_alike = 0.1, k_missing = 1.5, k_few = 0.1;
  constexpr std::size_t k_least = 8; // least number of steps that define a usual step
  const std::vector<double>& t = signal.breakpoints();
  if (t.size() < k_least + 1) return {};
  std::vector<double> steps;
  for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  std::optional<std::pair<double, double>> first;
  std::size_t missing = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (std::abs(steps[i] - *middle) <= k_alike * *middle) continue;
    if (steps[i] < k_missing * *middle) return {};
    if (i + 2 == t.size() || signal.value(t[i]) == signal.value(t[i + 1])) continue; // after the last row another definition may apply
    ++missing;
    if (!first) first = {t[i], t[i + 1]};
  }
  return static_cast<double>(missing) <= k_few * static_cast<double>(steps.size()) ? first : std::nullopt;
}

void find_gaps(const Model& model, const std::unordered_set<std::string>& used, SignalNetwork& network, std::vector<Finding>& findings) {
  for (const SignalEntry& entry : model.signals) {
    const std::string& name = entry.definition->name;
    if (entry.kind != &record_signal_kind() || (!used.contains(name) && !is_part(model, name))) continue;
    const Signal* const signal = network.build(name);
    if (const auto gap = signal ? missing_rows(*signal) : std::nullopt)
      findings.push_back(warning("rows_missing",
                                 "the rows of record '" + name + "' are evenly spaced except for a gap between t = " +
                                     rounded_text(gap->first) + " s and " + rounded_text(gap->second) + " s: are rows missing?",
                                 entry.definition->where));
  }
}

// Returns the two moving bodies whose values differ most, the smaller first.
template <class Value> std::pair<const Body*, const Body*> extremes_of(const Model& model, const Value& value) {
  const Body *least = nullptr, *most = nullptr;
  for (const Body& body : model.bodies) {
    if (body.fixed || !(value(body) > 0.0)) continue;
    if (!least || value(body) < value(*least)) least = &body;
    if (!most || value(body) > value(*most)) most = &body;
  }
  return {least, most};
}

// Checks the coefficient of friction of kinds that have one.
void check_friction(const ElementEntry& entry, std::vector<Finding>& findings) {
  if (!entry.kind->friction) return;
  const GivenFriction given = entry.kind->friction(*entry.element);
  if (!(given.coefficient > k_high_friction)) return;
  const std::string what = entry.kind->name + " '" + entry.element->name + "': '" + given.field + "' = " + number_text(given.coefficient);
  const Location& where = entry.element->where;
  if (!given.source.empty())
    findings.push_back(
        {"friction_by_source", FindingLevel::note, what + " is beyond what dry contacts usually have. Its source: " + given.source, where});
  else if (given.coefficient < k_implausible_friction)
    findings.push_back(
        warning("high_friction",
                what + " is high: dry contacts of machines have 0.1 to 0.8. If it is meant, say with 'source' where it comes from", where));
  else
    findings.push_back(warning("implausible_friction",
                               what + " is unlike any dry contact: 0.1 to 0.8 are usual, and rubber has 0.9. If it is meant, say with " +
                                   "'source' where it comes from",
                               where));
}

// Returns true for numbers with at most three decimals. Angles in degrees that lack their unit are round; radians from degrees or formulas
// are not.
bool is_round(double number) {
  constexpr double k_places = 1e3;
  return std::round(number * k_places) == number * k_places;
}

// Returns true if the run has another gravity than the file gives, as that of a load case with `pull`.
bool has_own_gravity(const LoadedModel& loaded) {
  return std::any_of(loaded.overrides.begin(), loaded.overrides.end(),
                     [](const std::string& change) { return change.starts_with("gravity="); });
}

// Returns the values of `pull`, m/s², of which one may be part of the gravity; none if the gravity is that of the file.
std::vector<Vec2> pulls_in_gravity(const LoadedModel& loaded) {
  std::vector<Vec2> pulls;
  if (!has_own_gravity(loaded)) return pulls;
  for (const LoadCase& one : load_cases_of(loaded.model))
    if (one.pull) pulls.push_back(*one.pull);
  return pulls;
}

void note_turns(const ModelEntry& entry, std::vector<Finding>& findings) {
  for (const Field& field : entry.fields->fields()) {
    if (field.type != FieldType::number || field.unit != "rad") continue;
    const FieldValue value = field.get(entry.object);
    const double* const angle = std::get_if<double>(&value);
    if (!angle || !(std::abs(*angle) > k_whole_turn) || !std::isfinite(*angle) || !is_round(*angle)) continue;
    findings.push_back({"more_than_a_turn",
                        FindingLevel::note,
                        entry.path + "." + field.name + " = " + number_text(*angle) + " rad is " + rounded_text(*angle / k_whole_turn, 3) +
                            " turns. If degrees are meant, write \"" + number_text(*angle) + " deg\"",
                        {}});
  }
}

} // namespace

std::vector<Finding> implausible_friction(const LoadedModel& loaded) {
  std::vector<Finding> findings;
  for (const ElementEntry& entry : loaded.model.elements) check_friction(entry, findings);
  const ActionGroup* const actions = action_group(*loaded.system);
  for (const ActionGroup::ElementData& action : actions ? actions->entries : std::vector<ActionGroup::ElementData>{})
    for (const ActionStep& step : action.steps) {
      if (step.verb != ActionVerb::set || !loaded.model.elements[static_cast<std::size_t>(step.target)].kind->friction) continue;
      Model then = loaded.model;
      const ElementEntry& entry = then.elements[static_cast<std::size_t>(step.target)];
      entry.kind->fields.find(step.field)->set(entry.element.get(), step.value);
      check_friction(entry, findings);
    }
  return findings;
}

std::vector<Finding> implausible_loads(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  const double end = model.simulation.end;
  std::vector<Finding> findings;
  SignalNetwork network(model);
  const std::unordered_set<std::string> used = used_signals(model);
  find_gaps(model, used, network, findings);
  bool has_load = false;
  const SignalEntry* silent = nullptr;
  for (const SignalEntry& entry : model.signals) {
    const std::string& name = entry.definition->name;
    const Signal* const signal = used.contains(name) ? network.build(name) : nullptr;
    if (!signal || signal->is_constant()) continue; // a constant of zero is intended
    if (!is_zero(*signal, end)) {
      has_load = true;
      continue;
    }
    if (!silent) silent = &entry;
    const std::vector<double>& breaks = signal->breakpoints();
    const auto next = std::upper_bound(breaks.begin(), breaks.end(), 0.0);
    const bool begins_later = next != breaks.end() && *next >= end; // acted_loads.h reports signals that begin after the end
    if (!begins_later) // reported only if no other load acts; joints report a missing load themselves
      findings.push_back(warning("load_is_zero", "signal '" + name + "' is zero throughout the run: what it drives is not loaded",
                                 entry.definition->where));
  }
  const bool is_at_rest = std::all_of(model.bodies.begin(), model.bodies.end(),
                                      [](const Body& body) { return body.velocity.isZero(0.0) && body.angular_velocity == 0.0; });
  if (has_load || !is_at_rest || has_own_gravity(loaded)) return findings;
  if (silent)
    findings.push_back(warning("no_load",
                               "every signal that varies is zero throughout the run: nothing loads the machine but what is constant, and "
                               "its load is not shown",
                               silent->definition->where));
  else if (const SignalEntry* const idle = idle_load(model, used, network))
    findings.push_back(warning("no_load",
                               "signal '" + idle->definition->name +
                                   "' is used by nothing, and no other load acts on the machine: name it in the element that it drives",
                               idle->definition->where));
  return findings;
}

std::vector<Finding> implausible_gravity(const LoadedModel& loaded) {
  constexpr double k_most = 60.0; // m/s²: Jupiter has 25; a constant pull of 5 g may be added, or one that takes nearly all of it
  const Vec2& gravity = loaded.model.header.gravity;
  const double size = gravity.norm();
  const std::vector<Vec2> pulls = pulls_in_gravity(loaded);
  // Straight up is a wrong sign. A scene that is turned as a whole has its gravity turned by any other angle.
  const auto points_up = [](const Vec2& g) { return g.x() == 0.0 && g.y() > 0.0; };
  if (pulls.empty() ? points_up(gravity) : std::all_of(pulls.begin(), pulls.end(), [&](const Vec2& p) { return points_up(gravity - p); }))
    return {
        warning("gravity_upwards",
                "gravity points upwards, with " + rounded_text(gravity.y(), 3) +
                    " m/s²: y counts upwards, so that gravity = [0, -9.81] is that of the Earth. Give the acceleration of a vehicle as " +
                    "the 'pull' of a [[case]]",
                loaded.model.header.where)};
  if (size <= k_most) return {};
  return {warning("implausible_gravity",
                  "gravity is " + rounded_text(size, 3) + " m/s², " + rounded_text(size / 9.80665, 3) +
                      " times that of the Earth: correct 'gravity'",
                  loaded.model.header.where)};
}

std::vector<Finding> magnitude_warnings(const LoadedModel& loaded) {
  const Model& model = loaded.model;
  std::vector<Finding> findings;
  for (const Body& body : model.bodies) {
    const double far = body.position.lpNorm<Eigen::Infinity>(), fast = body.velocity.lpNorm<Eigen::Infinity>();
    if (far > k_far)
      findings.push_back(
          warning("far_away", "body '" + body.name + "' lies " + number_text(far) + " m from the origin: is the unit meant?", body.where));
    if (fast > k_fast)
      findings.push_back(
          warning("very_fast", "body '" + body.name + "' moves with " + number_text(fast) + " m/s: is the unit meant?", body.where));
  }
  const auto compare = [&](const char* code, const char* what, const char* unit, const auto& value) {
    const auto [least, most] = extremes_of(model, value);
    if (!least || value(*most) <= k_apart * value(*least)) return;
    findings.push_back(warning(code,
                               std::string(what) + " of body '" + least->name + "', " + number_text(value(*least)) + " " + unit +
                                   ", is less than 1e-12 of that of '" + most->name + "', " + number_text(value(*most)) + " " + unit +
                                   ": their motions are not known relative to each other",
                               least->where));
  };
  for (const ModelEntry& entry : entries_of(model)) note_turns(entry, findings);
  compare("masses_apart", "the mass", "kg", [](const Body& body) { return body.mass; });
  compare("inertias_apart", "the inertia", "kg m²", [](const Body& body) { return body.inertia; });
  return findings;
}

} // namespace steplap
