#include "mbd/model/model_path.h"

#include "mbd/base/number_text.h"
#include "mbd/formula/unit_dimension.h"
#include "mbd/model/field_units.h"
#include "mbd/model/signal_use.h"
#include "mbd/model/validate.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace steplap {

namespace {

[[noreturn]] void complain(const std::string& path, const std::string& message) { throw ModelError(Location{path, 0, 0}, message); }

// Object and field to which a path refers, possibly one item of the field.
struct Target {
  const void* object = nullptr;
  const Field* field = nullptr;
  const FieldTable* fields = nullptr; ///< all fields of the object, on which its unit may depend
  std::string subject;
  std::vector<std::size_t> items; ///< one or two indices into the value of the field
};

// A named entry of one of the model's arrays, which a path may refer to.
struct Candidate {
  const std::string* name;
  const FieldTable* fields;
  const void* object;
  const FieldTable* common; ///< fields common to all entries of the array, or null
};

template <class Visit> void visit_entries(const Model& model, const std::string& array, const Visit& visit) {
  if (array == "body")
    for (const Body& body : model.bodies) visit(Candidate{&body.name, &Body::fields(), &body, nullptr});
  if (array == "marker")
    for (const Marker& marker : model.markers) visit(Candidate{&marker.name, &Marker::fields(), &marker, nullptr});
  if (array == "signal")
    for (const SignalEntry& e : model.signals) visit(Candidate{&e.definition->name, &e.kind->fields, e.definition.get(), nullptr});
  if (array == "element")
    for (const ElementEntry& e : model.elements)
      visit(Candidate{&e.element->name, &e.kind->fields, e.element.get(), &Element::common_fields()});
  for (const TableEntry& e : model.tables)
    if (e.kind->name == array) visit(Candidate{&e.table->name, &e.kind->fields, e.table.get(), nullptr});
}

class Resolver {
public:
  Resolver(const Model& model, const std::string& path) : model_(model), path_(path), rest_(path) {}

  Target resolve() {
    const std::string top = take();
    if (top == "simulation" || top == "output") {
      if (rest_.empty()) complain(path_, "name a key of '" + top + "', as in " + top + ".step");
      const bool is_output = top == "output";
      return field_of(is_output ? OutputSettings::fields() : SimulationSettings::fields(), nullptr,
                      is_output ? static_cast<const void*>(&model_.output) : &model_.simulation, "[" + top + "]", take());
    }
    if (ModelHeader::fields().find(top)) return field_of(ModelHeader::fields(), nullptr, &model_.header, "the model", top);
    return in_entry(top);
  }

private:
  // Removes the part of the path before the next point and returns it.
  std::string take() {
    const std::size_t point = rest_.find('.');
    std::string segment(rest_.substr(0, point));
    rest_ = point == std::string_view::npos ? std::string_view() : rest_.substr(point + 1);
    return segment;
  }

  Target in_entry(const std::string& array) {
    Candidate best{};
    visit_entries(model_, array, [&](const Candidate& c) {
      const std::string& name = *c.name;
      const bool leads = !name.empty() && rest_.size() > name.size() && rest_.starts_with(name) && rest_[name.size()] == '.';
      if (leads && (!best.name || name.size() > best.name->size())) best = c;
    });
    if (!best.name) {
      std::vector<std::string> known;
      visit_entries(model_, array, [&](const Candidate& c) { known.push_back(*c.name); });
      const std::string wanted(rest_.substr(0, rest_.rfind('.')));
      for (const char* name : {"body", "marker", "signal", "element"})
        if (array == name || !known.empty()) complain(path_, "there is no " + array + " '" + wanted + "'" + did_you_mean(wanted, known));
      complain(path_, "a model has no '" + array + "'");
    }
    rest_ = rest_.substr(best.name->size() + 1);
    return field_of(*best.fields, best.common, best.object, subject_text(array, *best.name), take());
  }

  Target field_of(const FieldTable& table, const FieldTable* common, const void* object, std::string subject, const std::string& name) {
    Target target{object, table.find(name), &table, std::move(subject), {}};
    if (!target.field && common) target.field = common->find(name);
    if (!target.field) complain(path_, "unknown key '" + name + "' in " + target.subject + did_you_mean(name, table.names()));
    while (!rest_.empty()) {
      const std::string item = take();
      std::size_t index = 0;
      const auto [end, status] = std::from_chars(item.data(), item.data() + item.size(), index);
      if (status != std::errc() || end != item.data() + item.size()) complain(path_, "'" + item + "' is not an item of '" + name + "'");
      target.items.push_back(index);
    }
    return target;
  }

  const Model& model_;
  const std::string& path_;
  std::string_view rest_;
};

// Returns the component of `value` with these indices; null if it does not exist.
double* component_of(FieldValue& value, const std::vector<std::size_t>& items) {
  const auto of_point = [](Vec2& p, std::size_t i) { return i < 2 ? &p[static_cast<Eigen::Index>(i)] : nullptr; };
  if (auto* p = std::get_if<Vec2>(&value); p && items.size() == 1) return of_point(*p, items[0]);
  if (auto* list = std::get_if<std::vector<double>>(&value); list && items.size() == 1)
    return items[0] < list->size() ? &(*list)[items[0]] : nullptr;
  if (auto* list = std::get_if<std::vector<Vec2>>(&value); list && items.size() == 2)
    return items[0] < list->size() ? of_point((*list)[items[0]], items[1]) : nullptr;
  return nullptr;
}

// Returns a description of the type of a value.
const char* text_of(const FieldValue& value) {
  static constexpr const char* k_texts[] = {"a number",          "an integer",       "true or false",   "a text",         "a point",
                                            "a list of numbers", "a list of points", "a list of rings", "a list of texts"};
  return k_texts[value.index()];
}

// Converts the value to the type of the field. Throws ModelError if it cannot.
FieldValue fitted(const std::string& path, const Target& target, FieldValue value) {
  const bool is_integer = target.field->type == FieldType::integer;
  if (const double* x = std::get_if<double>(&value); x && is_integer) {
    if (std::nearbyint(*x) != *x || std::abs(*x) > 9e15) complain(path, "expected an integer, got " + number_text(*x));
    return static_cast<long>(*x);
  }
  if (const long* n = std::get_if<long>(&value); n && !is_integer) return static_cast<double>(*n);
  return value;
}

// Returns the index in the variant FieldValue of the C++ type for this field type.
std::size_t index_of(FieldType type) {
  switch (type) {
  case FieldType::number: return FieldValue(0.0).index();
  case FieldType::integer: return FieldValue(0L).index();
  case FieldType::boolean: return FieldValue(false).index();
  case FieldType::vec2: return FieldValue(Vec2(Vec2::Zero())).index();
  case FieldType::numbers: return FieldValue(std::vector<double>()).index();
  case FieldType::points: return FieldValue(std::vector<Vec2>()).index();
  case FieldType::rings: return FieldValue(std::vector<std::vector<Vec2>>()).index();
  case FieldType::signals:
  case FieldType::elements:
  case FieldType::texts: return FieldValue(std::vector<std::string>()).index();
  default: return FieldValue(std::string()).index();
  }
}

constexpr std::string_view k_parameters = "parameters.";

// Returns the parameter that the path names, or nothing if the path does not begin with "parameters.".
std::optional<std::size_t> parameter_at(const Model& model, const std::string& path) {
  if (!path.starts_with(k_parameters)) return std::nullopt;
  const std::string name = path.substr(k_parameters.size());
  const std::optional<std::size_t> found = model.parameters.find(name);
  if (found) return found;
  std::vector<std::string> known;
  for (const Parameter& parameter : model.parameters.entries) known.push_back(parameter.name);
  complain(path, "there is no parameter '" + name + "'" + did_you_mean(name, known));
}

// Returns the present value of the formula in the form that its field requires. Limits of criteria are texts with a unit.
FieldValue value_for_field(const Model& model, const ParameterUse& use) {
  const double value = use.formula.value(model.parameters.values);
  if (!std::isfinite(value)) complain(use.path, "'" + use.text + "' has no finite value");
  if (!std::holds_alternative<std::string>(value_of(model, use.path))) return value;
  return number_text(value) + (use.unit.empty() ? "" : " " + use.unit);
}

void set_parameter(Model& model, std::size_t index, const std::string& path, const FieldValue& value) {
  Parameters& parameters = model.parameters;
  const Parameter& parameter = parameters.entries[index];
  if (parameter.formula) complain(path, "the parameter follows from others, '" + parameter.text + "': set those");
  const double* const number = std::get_if<double>(&value);
  const long* const whole = std::get_if<long>(&value);
  if (!number && !whole) complain(path, std::string("a parameter is a number, not ") + text_of(value));
  const double wanted = number ? *number : static_cast<double>(*whole);
  const std::string problem = problem_with(parameter, wanted);
  if (!problem.empty()) complain(path, problem);
  parameters.values[index] = wanted;
  parameters.evaluate();
  for (const std::size_t k : parameters.order)
    if (const std::string follows = problem_with(parameters.entries[k], parameters.values[k]); !follows.empty()) complain(path, follows);
  for (const ParameterUse& use : parameters.uses) {
    if (!parameters.needs(use.formula, index)) continue;
    if (!use.can_be_set) complain(path, "the parameter is needed by '" + use.path + "', which can be varied in the model's file only");
    set_value(model, use.path, value_for_field(model, use));
  }
}

} // namespace

void set_value(Model& model, const std::string& path, const FieldValue& value) {
  if (const std::optional<std::size_t> parameter = parameter_at(model, path)) return set_parameter(model, *parameter, path, value);
  const Target target = Resolver(model, path).resolve();
  FieldValue wanted = fitted(path, target, value);
  if (!target.items.empty()) {
    const double* const number = std::get_if<double>(&wanted);
    FieldValue whole = target.field->get(target.object);
    double* const component = component_of(whole, target.items);
    if (!component) complain(path, "'" + target.field->name + "' of " + target.subject + " has no such item");
    if (!number) complain(path, std::string("expected a number, got ") + text_of(wanted));
    *component = *number;
    wanted = std::move(whole);
  }
  const bool is_type = wanted.index() == index_of(target.field->type);
  if (!is_type) complain(path, "'" + target.field->name + "' of " + target.subject + " does not take " + text_of(wanted));
  std::string problem = range_problem(*target.field, wanted);
  if (!problem.empty()) complain(path, "'" + target.field->name + "' of " + target.subject + " " + problem);
  target.field->set(const_cast<void*>(target.object), wanted); // the object belongs to `model`, which is not const
}

FieldValue value_of(const Model& model, const std::string& path) {
  if (const std::optional<std::size_t> parameter = parameter_at(model, path)) return model.parameters.values[*parameter];
  const Target target = Resolver(model, path).resolve();
  FieldValue value = target.field->get(target.object);
  if (target.items.empty()) return value;
  const double* const component = component_of(value, target.items);
  if (!component) complain(path, "'" + target.field->name + "' of " + target.subject + " has no such item");
  return *component;
}

double number_of(const Model& model, const std::string& path) {
  const FieldValue value = value_of(model, path);
  if (const double* x = std::get_if<double>(&value)) return *x;
  if (const long* n = std::get_if<long>(&value)) return static_cast<double>(*n);
  complain(path, std::string("holds ") + text_of(value) + ", not a number");
}

std::string unit_of(const Model& model, const std::string& path) {
  (void)number_of(model, path);
  if (const std::optional<std::size_t> parameter = parameter_at(model, path)) return unit_text(model.parameters.entries[*parameter].powers);
  const Target target = Resolver(model, path).resolve();
  const bool is_second = target.field->type == FieldType::points && target.items.back() == 1;
  for (const SignalEntry& entry : model.signals)
    if (entry.definition.get() == target.object && is_in_unit_of_signal(*entry.kind, *target.field))
      return unit_taken(model, entry.definition->name);
  return is_second && !target.field->unit2.empty() ? target.field->unit2 : unit_in(*target.fields, *target.field, target.object);
}

} // namespace steplap
