#include "mbd/io/field_reader.h"

#include "mbd/base/number_text.h"
#include "mbd/io/parameters_reader.h"
#include "mbd/io/standalone_text.h"
#include "mbd/io/units.h"
#include "mbd/model/field_units.h"
#include "mbd/model/model.h"
#include "mbd/model/validate.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

std::string number_expectation(const std::string& unit) {
  if (unit.empty()) return "a number";
  return "a number or a string with a unit" + (unit == "*" ? "" : " like '" + unit + "'");
}

std::string dimension_note(const std::string& unit) {
  if (unit.empty()) return "";
  return unit == "*" ? ", each a number or a string with a unit" : ", each a number in " + unit + " or a string with a unit";
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

// Error in a value, thrown and caught within this file only. The message is empty if the error was reported already.
struct BadValue {
  const Node* node;
  std::string message;
};

class ValueReader {
public:
  ValueReader(const Field& field, const TableReading& reading) : field_(field), reading_(reading) {}

  FieldValue read(const Node& node) const {
    switch (field_.type) {
    case FieldType::number: return number(node, field_.unit);
    case FieldType::integer: return integer(node);
    case FieldType::boolean: return boolean(node);
    case FieldType::vec2: return point(node, field_.unit, field_.unit);
    case FieldType::numbers: return numbers(node);
    case FieldType::points: return points(node);
    case FieldType::rings: return rings(node);
    case FieldType::signals:
    case FieldType::elements:
    case FieldType::texts: return texts(node);
    case FieldType::marker:
      if (node.is_table()) return reading_.add_marker(node, field_);
      return text(node);
    case FieldType::file: return path(node);
    case FieldType::quantity: return quantity(node);
    case FieldType::choice: return choice(node);
    default: return text(node);
    }
  }

private:
  [[noreturn]] void unexpected(const Node& node) const {
    throw BadValue{&node, "expected " + expected_text(field_) + ", got " + node.type_name()};
  }

  double number(const Node& node, const std::string& unit) const {
    if (node.type == Node::Type::integer) return static_cast<double>(std::get<long>(node.scalar));
    if (node.type == Node::Type::number) return std::get<double>(node.scalar);
    if (node.type != Node::Type::text) unexpected(node);
    if (is_formula(node)) return formula(node, unit);
    const Quantity quantity = parse_quantity(node.text(), unit);
    if (!quantity.problem.empty()) throw BadValue{&node, quantity.problem};
    return quantity.value;
  }

  double formula(const Node& node, const std::string& unit) const {
    if (!reading_.parameters) throw BadValue{&node, "formulas of [parameters] are for models; got '" + node.text() + "'"};
    const Quantity quantity = reading_.parameters->value(node, unit);
    if (!quantity.problem.empty() || reading_.parameters->is_excused()) throw BadValue{&node, quantity.problem};
    return quantity.value;
  }

  long integer(const Node& node) const {
    if (node.type == Node::Type::integer) return std::get<long>(node.scalar);
    const bool is_given = is_formula(node);
    if (node.type != Node::Type::number && !is_given) unexpected(node);
    const double value = is_given ? formula(node, "") : std::get<double>(node.scalar); // 1e5 counts as an integer
    if (is_given && std::nearbyint(value) != value)
      throw BadValue{&node, "the formula gives " + number_text(value) + ", but an integer is needed"};
    if (std::nearbyint(value) != value || std::abs(value) > 9e15) unexpected(node);
    return static_cast<long>(value);
  }

  bool boolean(const Node& node) const {
    if (node.type != Node::Type::boolean) unexpected(node);
    return std::get<bool>(node.scalar);
  }

  std::string text(const Node& node) const {
    if (node.type != Node::Type::text) unexpected(node);
    return node.text();
  }

  // Returns a choice. An empty text is refused, because it represents a field that is not given.
  std::string choice(const Node& node) const {
    std::string chosen = text(node);
    if (chosen.empty() && !field_.is_required)
      throw BadValue{&node, "expected " + expected_text(field_) + ", got an empty text: leave the line out if none of them is meant"};
    return chosen;
  }

  std::string quantity(const Node& node) const {
    const double value = number(node, "*"); // checks now that the text is a quantity in some unit
    if (is_formula(node)) return reading_.parameters->text_of(node);
    return node.type == Node::Type::text ? node.text() : number_text(value);
  }

  std::string path(const Node& node) const { return path_named_by(node, text(node)); }

  Vec2 point(const Node& node, const std::string& unit_x, const std::string& unit_y) const {
    if (node.type != Node::Type::array) unexpected(node);
    if (node.children.size() != 2)
      throw BadValue{&node, "expected " + expected_text(field_) + ", got a list of length " + std::to_string(node.children.size())};
    return {number(node.children[0], unit_x), number(node.children[1], unit_y)};
  }

  std::vector<double> numbers(const Node& node) const {
    if (node.type != Node::Type::array) unexpected(node);
    std::vector<double> result;
    for (const Node& item : node.children) result.push_back(number(item, field_.unit));
    return result;
  }

  std::vector<Vec2> points(const Node& node) const {
    if (node.type != Node::Type::array) unexpected(node);
    const std::string& unit_y = field_.unit2.empty() ? field_.unit : field_.unit2;
    std::vector<Vec2> result;
    for (const Node& item : node.children) result.push_back(point(item, field_.unit, unit_y));
    return result;
  }

  std::vector<std::vector<Vec2>> rings(const Node& node) const {
    if (node.type != Node::Type::array) unexpected(node);
    std::vector<std::vector<Vec2>> result;
    for (const Node& item : node.children) result.push_back(points(item));
    return result;
  }

  std::vector<std::string> texts(const Node& node) const {
    if (node.type != Node::Type::array) unexpected(node);
    std::vector<std::string> result;
    for (const Node& item : node.children) result.push_back(text(item));
    return result;
  }

  const Field& field_;
  const TableReading& reading_;
};

bool is_known(const std::string& key, const TableReading& reading) {
  return reading.knows_all_keys || std::find(reading.known_keys.begin(), reading.known_keys.end(), key) != reading.known_keys.end();
}

// Reports an unknown key. Returns the most similar known key; "" if none is similar.
std::string report_unknown(const Node& child, const FieldTable& fields, const TableReading& reading, std::vector<Diagnostic>& problems) {
  std::vector<std::string> known = reading.known_keys;
  for (const std::string& name : fields.names())
    if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  std::string hint = did_you_mean(child.key, known);
  if (hint.empty()) hint = "; known are " + list_of(known);
  problems.push_back({child.where_key(), "unknown key '" + child.key + "' in " + reading.subject + hint});
  return nearest_name(child.key, known);
}

// Reads a value. The unit of some fields depends on other fields of `object`, which must have been read before.
FieldValue read_value(const Node& child, const FieldTable& fields, const Field& field, const void* object, const TableReading& reading) {
  if (!depends_on_other_fields(field)) return ValueReader(field, reading).read(child);
  Field own = field;
  own.unit = unit_in(fields, field, object);
  return ValueReader(own, reading).read(child);
}

GivenField read_field(const Node& child, const FieldTable& fields, const Field& field, void* object, const TableReading& reading,
                      std::vector<Diagnostic>& problems) {
  try {
    field.set(object, read_value(child, fields, field, object, reading));
  } catch (const BadValue& bad) {
    if (!bad.message.empty()) problems.push_back({bad.node->where(), "'" + field.name + "' of " + reading.subject + ": " + bad.message});
    return {&field, &child, false};
  }
  return {&field, &child, true};
}

// Returns the field to which the key belonged in an earlier version under another name; nullptr if there is none. Reports an error if the
// field is also given under its present name.
const Field* renamed_field(const Node& table, const Node& child, const FieldTable& fields, const TableReading& reading,
                           std::vector<Diagnostic>& problems) {
  const Field* const field = fields.find_earlier(child.key);
  if (!field || is_known(child.key, reading)) return nullptr;
  if (table.find(field->name)) {
    problems.push_back({child.where_key(), "'" + child.key + "' of " + reading.subject + " is the earlier name of '" + field->name +
                                               "', which is given as well: leave '" + child.key + "' out"});
    return nullptr;
  }
  if (reading.renamed) reading.renamed->push_back({child.where_key(), child.key, field->name, reading.subject});
  return field;
}

// Reports missing required fields, except those in `misspelt`: their misspelt keys were reported as unknown.
void report_missing(const Node& table, const FieldTable& fields, const TableReading& reading, const std::vector<std::string>& misspelt,
                    std::vector<GivenField>& given, std::vector<Diagnostic>& problems) {
  for (const Field& field : fields.fields()) {
    const bool is_misspelt = std::find(misspelt.begin(), misspelt.end(), field.name) != misspelt.end();
    const bool is_excused = reading.is_excused && reading.is_excused(field);
    const bool is_given = table.find(field.name) || (!field.earlier_name.empty() && table.find(field.earlier_name));
    if (is_given || (!is_misspelt && (!field.is_required || is_excused))) continue;
    given.push_back({&field, nullptr, false});
    if (!is_misspelt) problems.push_back({table.where(), missing_field_message(field, reading.subject)});
  }
}

} // namespace

std::string expected_text(const Field& field) {
  switch (field.type) {
  case FieldType::number: return number_expectation(field.unit);
  case FieldType::integer: return "an integer";
  case FieldType::boolean: return "true or false";
  case FieldType::text: return "a string";
  case FieldType::choice: return "one of " + list_of(field.choices);
  case FieldType::vec2: return "[x, y]" + dimension_note(field.unit);
  case FieldType::numbers: return "a list of numbers" + dimension_note(field.unit);
  case FieldType::points: return "a list of points [x, y]";
  case FieldType::rings: return "a list of rings, each a list of points [x, y]";
  case FieldType::body: return "the name of a body";
  case FieldType::marker: return "the name of a marker or body, or { body = ..., point = [x, y] }";
  case FieldType::signal: return "the name of a signal (a constant value is a signal of kind 'constant')";
  case FieldType::signals: return "a list of names of signals";
  case FieldType::element: return "the name of an element";
  case FieldType::elements: return "a list of names of elements";
  case FieldType::texts: return "a list of strings";
  case FieldType::file: return "the name of a file";
  case FieldType::quantity: return number_expectation("*");
  }
  return "a value";
}

std::vector<GivenField> read_fields(const Node& table, const FieldTable& fields, void* object, const TableReading& reading,
                                    std::vector<Diagnostic>& problems) {
  std::vector<GivenField> given;
  std::vector<std::string> misspelt;
  std::vector<std::pair<const Node*, const Field*>> later; // fields whose units depend on other fields
  for (const Node& child : table.children) {
    const Field* field = fields.find(child.key);
    if (!field) field = renamed_field(table, child, fields, reading, problems);
    if (field && depends_on_other_fields(*field)) later.emplace_back(&child, field);
    else if (field) given.push_back(read_field(child, fields, *field, object, reading, problems));
    else if (!is_known(child.key, reading) && !fields.find_earlier(child.key))
      misspelt.push_back(report_unknown(child, fields, reading, problems));
  }
  for (const auto& [child, field] : later) given.push_back(read_field(*child, fields, *field, object, reading, problems));
  report_missing(table, fields, reading, misspelt, given, problems);
  return given;
}

} // namespace steplap
