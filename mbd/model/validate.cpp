#include "mbd/model/validate.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/model/field_units.h"
#include "mbd/model/method.h"
#include "mbd/model/signal_network.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace steplap {

bool has_fixed_step(const std::string& integrator) {
  const auto found = std::find_if(methods().begin(), methods().end(), [&](const Method& m) { return m.name == integrator; });
  return found != methods().end() && found->has_fixed_step; // unknown names are reported elsewhere
}

std::string subject_text(const std::string& kind, const std::string& name) {
  if (!name.empty()) return kind + " '" + name + "'";
  const bool vowel = std::string("aeiou").find(kind.front()) != std::string::npos;
  return (vowel ? "an " : "a ") + kind;
}

std::string missing_field_message(const Field& field, const std::string& subject) {
  std::string text = subject + " needs '" + field.name + "' (" + field.doc;
  if (!field.unit.empty() && field.unit != "*") text += "; in " + shown_unit(field);
  return text + ")";
}

bool is_excused(const Body& body, const Field& field) { return body.fixed && (field.name == "mass" || field.name == "inertia"); }

namespace {

std::string place_text(const Location& first, const Location& second) {
  if (first.line == 0) return "";
  std::string text = " (line " + std::to_string(first.line);
  if (first.file != second.file) text += " of " + std::filesystem::path(first.file).filename().string();
  return text + ")";
}

std::string of(const Field& field, const std::string& subject) { return "'" + field.name + "' of " + subject; }

std::string with_unit(double value, const std::string& unit) {
  const bool is_known = !unit.empty() && unit != "*" && unit.find('|') == std::string::npos;
  return number_text(value) + (is_known ? " " + unit : "");
}

std::string reference_noun(FieldType type) {
  switch (type) {
  case FieldType::body: return "body";
  case FieldType::marker: return "marker or body";
  case FieldType::signal:
  case FieldType::signals: return "signal";
  default: return "element";
  }
}

// Returns true for an empty text, which also represents an optional number without a value.
bool is_absent(const FieldValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  return text && text->empty();
}

// Returns true if a number, or a component of a point, is within the range of the field. Checked before the message is composed, which is
// slow.
bool is_allowed(const Field& field, double value) {
  const bool is_above = field.is_minimum_excluded ? value > field.minimum : value >= field.minimum;
  return std::isfinite(value) && is_above && value <= field.maximum;
}
bool is_allowed(const Field& field, const Vec2& p) { return is_allowed(field, p.x()) && is_allowed(field, p.y()); }
template <class T> bool is_allowed(const Field& field, const std::vector<T>& list) {
  return std::all_of(list.begin(), list.end(), [&field](const T& item) { return is_allowed(field, item); });
}

std::string number_problem(const Field& field, double value) {
  if (is_allowed(field, value)) return {};
  std::string need;
  if (!std::isfinite(value)) need = "finite";
  else if (field.is_minimum_excluded && !(value > field.minimum)) need = "greater than " + with_unit(field.minimum, field.unit);
  else if (value < field.minimum) need = "at least " + with_unit(field.minimum, field.unit);
  else if (value > field.maximum) need = "at most " + with_unit(field.maximum, field.unit);
  return need.empty() ? "" : "must be " + need + ", got " + number_text(value);
}

std::string choice_problem(const Field& field, const std::string& value) {
  std::string list;
  for (const std::string& choice : field.choices) {
    if (choice == value) return "";
    list += (list.empty() ? "'" : ", '") + choice + "'";
  }
  return "must be one of " + list + ", got '" + value + "'" + did_you_mean(value, field.choices);
}

// Returns the message for the first number in the value that is out of range; "" if all are in range.
std::string first_problem(const Field& field, double value) { return number_problem(field, value); }
std::string first_problem(const Field& field, const Vec2& p) {
  const std::string of_x = number_problem(field, p.x());
  return of_x.empty() ? number_problem(field, p.y()) : of_x;
}
template <class T> std::string first_problem(const Field& field, const std::vector<T>& list) {
  if (is_allowed(field, list)) return {};
  for (const T& item : list)
    if (std::string problem = first_problem(field, item); !problem.empty()) return problem;
  return "";
}

} // namespace

std::string range_problem(const Field& field, const FieldValue& value) {
  switch (field.type) {
  case FieldType::number: return number_problem(field, std::get<double>(value));
  case FieldType::integer: return number_problem(field, static_cast<double>(std::get<long>(value)));
  case FieldType::vec2: return first_problem(field, std::get<Vec2>(value));
  case FieldType::numbers: return first_problem(field, std::get<std::vector<double>>(value));
  case FieldType::points: return first_problem(field, std::get<std::vector<Vec2>>(value));
  case FieldType::rings: return first_problem(field, std::get<std::vector<std::vector<Vec2>>>(value));
  case FieldType::choice: return choice_problem(field, std::get<std::string>(value));
  default: return "";
  }
}

bool is_in_range(const Field& field, const void* object) {
  const FieldValue value = field.get(object);
  return is_absent(value) || range_problem(field, value).empty();
}

FieldChecker::FieldChecker(const Model& model, std::vector<Diagnostic>& problems) : problems_(problems) {
  bodies_.insert("ground");
  for (const Body& body : model.bodies) bodies_.insert(body.name);
  for (const Marker& marker : model.markers) markers_.insert(marker.name);
  for (const SignalEntry& entry : model.signals) signals_.insert(entry.definition->name);
  for (const ElementEntry& entry : model.elements) elements_.insert(entry.element->name);
}

void FieldChecker::check(const FieldTable& table, const void* object, const std::string& subject, const Locate& locate) {
  for (const Field& field : table.fields()) check_field(field, field.get(object), subject, locate);
}

// A field is located only for a message: its location contains the name of the file, and most fields of a large model need none.
void FieldChecker::check_field(const Field& field, const FieldValue& value, const std::string& subject, const Locate& locate) {
  const auto report = [&](const std::string& message) {
    if (const std::optional<Location> where = locate(field.name)) problems_.push_back({*where, message});
  };
  if (is_absent(value)) {
    if (field.is_required && field.name != "name") report(missing_field_message(field, subject)); // names are checked separately
    return;
  }
  if (const std::string problem = range_problem(field, value); !problem.empty()) report(of(field, subject) + " " + problem);
  switch (field.type) {
  case FieldType::body:
  case FieldType::marker:
  case FieldType::signal:
  case FieldType::element: check_reference(field, std::get<std::string>(value), subject, locate); break;
  case FieldType::signals:
  case FieldType::elements:
    for (const std::string& name : std::get<std::vector<std::string>>(value)) check_reference(field, name, subject, locate);
    break;
  default: break;
  }
}

void FieldChecker::check_reference(const Field& field, const std::string& name, const std::string& subject, const Locate& locate) {
  if (refers(field.type, name)) return;
  const std::optional<Location> where = locate(field.name);
  if (!where) return;
  problems_.push_back(
      {*where, of(field, subject) + ": there is no " + reference_noun(field.type) + " '" + name + "'" + suggestion(field.type, name)});
}

bool FieldChecker::refers(FieldType type, const std::string& name) const {
  switch (type) {
  case FieldType::body: return bodies_.count(name) > 0;
  case FieldType::marker: return markers_.count(name) > 0 || bodies_.count(name) > 0;
  case FieldType::signal:
  case FieldType::signals: return signals_.count(name) > 0;
  default: return elements_.count(name) > 0;
  }
}

std::string FieldChecker::suggestion(FieldType type, const std::string& name) {
  if (--suggestions_left_ < 0) return "";
  std::vector<std::string> known;
  const auto take = [&](const Names& names) { known.insert(known.end(), names.begin(), names.end()); };
  if (type == FieldType::marker) take(markers_);
  if (type == FieldType::marker || type == FieldType::body) take(bodies_);
  if (type == FieldType::signal || type == FieldType::signals) take(signals_);
  if (type == FieldType::element || type == FieldType::elements) take(elements_);
  std::sort(known.begin(), known.end()); // makes the choice among equally near names deterministic
  return did_you_mean(name, known);
}

namespace {

// Collects the errors of one model.
class Validation {
public:
  Validation(const Model& model, const FieldLocator& locate) : model_(model), locate_(locate), checker_(model, problems_) {}

  std::vector<Diagnostic> run() {
    if (model_.bodies.empty())
      if (const auto where = locate(Section::header, 0, "body", model_.header.where))
        add(*where, "the model has no body: add at least one [[body]]");
    check_table(Section::header, 0, ModelHeader::fields(), &model_.header, "the model", model_.header.where);
    check_table(Section::simulation, 0, SimulationSettings::fields(), &model_.simulation, "[simulation]", model_.simulation.where);
    check_table(Section::output, 0, OutputSettings::fields(), &model_.output, "[output]", model_.output.where);
    check_settings();
    check_bodies();
    check_markers();
    check_signals();
    check_elements();
    return std::move(problems_);
  }

private:
  void add(const Location& where, std::string message) { problems_.push_back({where, std::move(message)}); }

  std::optional<Location> locate(Section section, std::size_t index, const std::string& field, const Location& fallback) const {
    return locate_ ? locate_(section, index, field) : fallback;
  }

  void check_table(Section section, std::size_t index, const FieldTable& table, const void* object, const std::string& subject,
                   const Location& where) {
    checker_.check(table, object, subject, [&](const std::string& field) { return locate(section, index, field, where); });
  }

  struct Named { ///< object with a name
    std::size_t index = 0;
    const Location* where = nullptr; ///< never nullptr
  };
  using Seen = std::unordered_map<std::string_view, Named>;

  // Checks that the name is given and unique.
  void check_name(Section section, std::size_t index, const std::string& noun, const std::string& name, const Location& where, Seen& seen) {
    const auto place_of = [&](const Named& named) { return locate(section, named.index, "name", *named.where); };
    const auto [first, is_new] = seen.emplace(name, Named{index, &where});
    const bool is_text = !name.empty() && !has_control_character(name);
    const bool is_cell = name.empty() || std::string_view("=+-@").find(name.front()) == std::string_view::npos;
    if (is_text && is_cell && is_new) return;
    const std::optional<Location> place = place_of({index, &where});
    if (!place) return;
    if (name.empty()) return add(*place, "the name of " + subject_text(noun, "") + " must not be empty");
    if (place->line == 0 && !is_text) // names from files are checked for control characters when the file is read
      add(*place, subject_text(noun, "") + " '" + name + "': the name must not hold control characters");
    if (!is_cell) // names are written to cells of CSV files
      add(*place, subject_text(noun, "") + " '" + name + "': the name must not begin with '" + name.front() +
                      "', which a spreadsheet takes for a formula");
    if (is_new) return;
    if (const std::optional<Location> before = place_of(first->second))
      add(*place, subject_text(noun, "") + " named '" + name + "' exists already" + place_text(*before, *place) + ": choose another name");
  }

  void check_settings();
  void check_bodies();
  void check_markers();
  void check_signals();
  void check_elements();
  bool is_readable(std::size_t signal) const;
  void check_signal_value(SignalNetwork& network, const std::string& name);

  const Model& model_;
  const FieldLocator& locate_;
  std::vector<Diagnostic> problems_;
  FieldChecker checker_;
};

void Validation::check_settings() {
  const SimulationSettings& s = model_.simulation;
  const auto complain = [&](Section section, const std::string& field, const std::string& message) {
    const Location& fallback = section == Section::output ? model_.output.where : s.where;
    if (const auto where = locate(section, 0, field, fallback)) add(*where, message);
  };
  // Fixed-step methods need 'step', adaptive ones 'tolerance'. A file may contain both, so that the integrator can be changed alone.
  if (has_fixed_step(s.integrator) && !s.step)
    complain(Section::simulation, "step",
             "[simulation] needs 'step' for the fixed-step integrator '" + s.integrator + "', for example step = 1e-4");
  const std::string end = "'end' of [simulation], " + number_text(s.end) + " s";
  if (s.step && *s.step > s.end && s.end > 0.0)
    complain(Section::simulation, "step", "'step' of [simulation], " + number_text(*s.step) + " s, is larger than " + end);
  if (s.step && has_fixed_step(s.integrator) && s.end / *s.step > k_most_steps)
    complain(Section::simulation, "step",
             "'step' of [simulation], " + number_text(*s.step) + " s, takes " + number_text(s.end / *s.step) + " steps to " + end +
                 ": choose a larger one; more than " + number_text(k_most_steps) + " steps are not begun");
  if (model_.output.step > s.end && s.end > 0.0)
    complain(Section::output, "step", "'step' of [output], " + number_text(model_.output.step) + " s, is larger than " + end);
}

void Validation::check_bodies() {
  Seen seen;
  for (std::size_t i = 0; i < model_.bodies.size(); ++i) {
    const Body& body = model_.bodies[i];
    check_name(Section::body, i, "body", body.name, body.where, seen);
    if (body.name == "ground")
      if (const auto where = locate(Section::body, i, "name", body.where))
        add(*where, "the name 'ground' is taken by the ground: choose another name");
    checker_.check(Body::fields(), &body, subject_text("body", body.name), [&](const std::string& name) -> std::optional<Location> {
      const Field& field = *Body::fields().find(name);
      if (is_excused(body, field) && std::get<double>(field.get(&body)) == 0.0) return std::nullopt;
      return locate(Section::body, i, name, body.where);
    });
  }
}

// Returns true if the marker, which has the name of its body (null: the ground), is not that body's centre of gravity with its axes.
static bool is_elsewhere(const Marker& marker, const Body* own) {
  if (marker.body != marker.name || (!own && marker.name != "ground")) return false;
  return marker.at || marker.angle != 0.0 || marker.point.value_or(Vec2::Zero()) != (own ? own->cg : Vec2(Vec2::Zero()));
}

void Validation::check_markers() {
  Seen seen;
  for (std::size_t i = 0; i < model_.markers.size(); ++i) {
    const Marker& marker = model_.markers[i];
    const std::string subject = subject_text("marker", marker.name);
    check_name(Section::marker, i, "marker", marker.name, marker.where, seen);
    check_table(Section::marker, i, Marker::fields(), &marker, subject, marker.where);
    if (checker_.is_body(marker.name) && marker.body != marker.name)
      if (const auto where = locate(Section::marker, i, "name", marker.where))
        add(*where, subject + " has the name of a body, which stands for that body's centre of "
                              "gravity: choose another name");
    if (is_elsewhere(marker, model_.find_body(marker.name)))
      if (const auto where = locate(Section::marker, i, "name", marker.where))
        add(*where, subject + " has the name of its own body, which stands for that body's centre of gravity: choose another name");
    if (marker.point && marker.at)
      if (const auto where = locate(Section::marker, i, "at", marker.where))
        add(*where, subject + " gives both 'point' and 'at': give one of them");
  }
}

// Returns true if all fields of the signal could be read.
bool Validation::is_readable(std::size_t signal) const {
  const SignalEntry& entry = model_.signals[signal];
  for (const Field& field : entry.kind->fields.fields())
    if (!locate(Section::signal, signal, field.name, entry.definition->where)) return false;
  return true;
}

void Validation::check_signal_value(SignalNetwork& network, const std::string& name) {
  try {
    static_cast<void>(network.build(name));
  } catch (const ModelError& error) {
    problems_.insert(problems_.end(), error.diagnostics().begin(), error.diagnostics().end());
  }
}

void Validation::check_signals() {
  Seen seen;
  SignalNetwork network(model_);
  for (std::size_t i = 0; i < model_.signals.size(); ++i) {
    const SignalEntry& entry = model_.signals[i];
    const SignalDefinition& signal = *entry.definition;
    check_name(Section::signal, i, "signal", signal.name, signal.where, seen);
    const std::size_t before = problems_.size();
    check_table(Section::signal, i, entry.kind->fields, &signal, subject_text(entry.kind->name, signal.name), signal.where);
    if (problems_.size() != before || !is_readable(i)) network.exclude(signal.name);
  }
  for (const SignalEntry& entry : model_.signals) check_signal_value(network, entry.definition->name);
}

void Validation::check_elements() {
  Seen seen;
  for (std::size_t i = 0; i < model_.elements.size(); ++i) {
    const ElementEntry& entry = model_.elements[i];
    const Element& element = *entry.element;
    check_name(Section::element, i, "element", element.name, element.where, seen);
    const std::string subject = subject_text(entry.kind->name, element.name);
    for (const FieldTable* table : {&entry.kind->fields, &Element::common_fields()})
      check_table(Section::element, i, *table, &element, subject, element.where);
  }
}

} // namespace

std::vector<Diagnostic> validate(const Model& model, const FieldLocator& locate) { return Validation(model, locate).run(); }

} // namespace steplap
