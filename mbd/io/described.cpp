#include "mbd/io/described.h"

#include "mbd/base/number_text.h"
#include "mbd/io/parts.h"

namespace steplap {

namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return result + "\"";
}

std::string item_text(double value) { return number_text(value); }
std::string item_text(const std::string& value) { return quoted(value); }
std::string item_text(const Vec2& p) { return "[" + number_text(p.x()) + ", " + number_text(p.y()) + "]"; }

struct ValueText {
  std::string operator()(double value) const { return number_text(value); }
  std::string operator()(long value) const { return std::to_string(value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return value.empty() ? "" : quoted(value); }
  std::string operator()(const Vec2& value) const { return item_text(value); }
  template <class T> std::string operator()(const std::vector<T>& list) const {
    std::string text;
    for (const T& item : list) text += (text.empty() ? "" : ", ") + item_text(item);
    return "[" + text + "]";
  }
  std::string operator()(const std::vector<std::vector<Vec2>>& rings) const {
    std::string text;
    for (const std::vector<Vec2>& ring : rings) text += (text.empty() ? "" : ", ") + (*this)(ring);
    return "[" + text + "]";
  }
};

template <class T> std::shared_ptr<const void> made() { return std::make_shared<T>(); }

} // namespace

std::string Described::default_text(const Field& field) const {
  if (field.is_required) return "";
  return std::visit(ValueText{}, field.get(defaults.get()));
}

Described describe_common_fields() {
  return {"common", "element", "Fields that elements of every kind have, besides 'name' and 'kind'.", &Element::common_fields(),
          made<Element>()};
}

std::vector<Described> describe(const Catalogue& catalogue) {
  std::vector<Described> all;
  all.push_back({"model", "model", "Top-level keys of a model file.", &ModelHeader::fields(), made<ModelHeader>()});
  all.push_back({"settings", "simulation", "How the run is computed.", &SimulationSettings::fields(), made<SimulationSettings>()});
  all.push_back({"settings", "output", "What the run writes.", &OutputSettings::fields(), made<OutputSettings>()});
  all.push_back({"table", "part",
                 "Another model file as a sub-assembly (docs/how-to/models_written_once.md). `parameters`, a table, gives its [parameters] "
                 "other values.",
                 &PartEntry::fields(), made<PartEntry>()});
  all.push_back({"table", "body",
                 "A rigid body; a fixed one needs no mass and inertia, nor one that a table, such "
                 "as a core's, gives them.",
                 &Body::fields(), made<Body>()});
  all.push_back({"table", "marker",
                 "A point and axes fixed in a body or the ground, given by 'point' or 'at'; without "
                 "either at the body's centre of gravity.",
                 &Marker::fields(), made<Marker>()});
  for (const SignalKind* kind : catalogue.signals) all.push_back({"signal", kind->name, kind->doc, &kind->fields, kind->create()});
  all.push_back(describe_common_fields());
  for (const ElementKind* kind : catalogue.elements) all.push_back({"element", kind->name, kind->doc, &kind->fields, kind->create()});
  for (const TableKind* kind : catalogue.tables) all.push_back({"table", kind->name, kind->doc, &kind->fields, kind->create()});
  return all;
}

std::string type_text(const Field& field) {
  switch (field.type) {
  case FieldType::number:
  case FieldType::quantity: return "number";
  case FieldType::integer: return "integer";
  case FieldType::boolean: return "true or false";
  case FieldType::text: return "text";
  case FieldType::choice: break;
  case FieldType::vec2: return "[x, y]";
  case FieldType::numbers: return "list of numbers";
  case FieldType::points: return "list of [x, y]";
  case FieldType::rings: return "list of lists of [x, y]";
  case FieldType::body: return "body";
  case FieldType::marker: return "marker";
  case FieldType::signal: return "signal";
  case FieldType::signals: return "list of signals";
  case FieldType::element: return "element";
  case FieldType::elements: return "list of elements";
  case FieldType::texts: return "list of texts";
  case FieldType::file: return "file";
  }
  std::string text;
  for (const std::string& choice : field.choices) text += (text.empty() ? "" : " | ") + quoted(choice);
  return text;
}

} // namespace steplap
