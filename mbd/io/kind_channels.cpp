#include "mbd/io/kind_channels.h"

#include "mbd/base/number_text.h"
#include "mbd/io/reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace steplap {

namespace {

constexpr const char* k_scene = R"(gravity = [0.0, 0.0]
[output]
also = ["*"]
[[body]]
name = "a"
mass = 1.0
inertia = 1.0
position = [0.0, 1.0]
outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
[[body]]
name = "b"
mass = 1.0
inertia = 1.0
position = [0.0, -1.0]
outline = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
[[marker]]
name = "M"
body = "a"
)";

constexpr const char* k_signal = R"([[signal]]
name = "s"
kind = "haversine"
peak = 1.0
duration = 1.0
)";

// Returns a number within the field's range, as TOML.
std::string number_for(const Field& field) {
  double value = 1.0;
  if (value < field.minimum || (value == field.minimum && field.is_minimum_excluded)) value = field.minimum + 1.0;
  if (value > field.maximum) value = std::isfinite(field.minimum) ? 0.5 * (field.minimum + field.maximum) : field.maximum;
  return number_text(value);
}

// Returns a sample value for the field as TOML; "" if there is none for its type. `index` makes values different.
std::string value_for(const Field& field, int index) {
  switch (field.type) {
  case FieldType::number: return number_for(field);
  case FieldType::integer: return std::to_string(static_cast<long>(std::max(1.0, std::isfinite(field.minimum) ? field.minimum : 1.0)));
  case FieldType::boolean: return "true";
  case FieldType::vec2: return "[" + std::to_string(index) + ".0, 0.5]";
  case FieldType::signal: return "\"s\"";
  case FieldType::marker:
  case FieldType::body: return index == 0 ? "\"a\"" : "\"b\"";
  default: return "";
  }
}

std::string line(const Field& field, const std::string& value) { return field.name + " = " + value + "\n"; }

std::string required_fields(const ElementKind& kind) {
  std::string text;
  int place = 0, point = 0;
  for (const Field& field : kind.fields.fields()) {
    const bool is_place = field.type == FieldType::marker || field.type == FieldType::body;
    if (!field.is_required) continue;
    text += line(field, value_for(field, is_place ? place++ : field.type == FieldType::vec2 ? point++ : 0));
  }
  return text;
}

bool is_required(const ElementKind& kind, const std::string& name) {
  const Field* const field = kind.fields.find(name);
  return field && field->is_required;
}

// Returns variants of the sample as TOML lines: without any line, and one for each value of each choice and each switch set to true.
std::vector<std::string> choices_of(const ElementKind& kind) {
  std::vector<std::string> list{""};
  for (const Field& field : kind.fields.fields()) {
    if (field.is_required) continue;
    for (const std::string& choice : field.choices) list.push_back(line(field, "\"" + choice + "\""));
    if (field.type == FieldType::boolean) list.push_back(line(field, "true"));
  }
  return list;
}

// Returns variants of the optional numbers as TOML lines: none, each one alone, and all.
std::vector<std::string> extras_of(const ElementKind& kind) {
  std::vector<std::string> list{""};
  std::string all;
  for (const Field& field : kind.fields.fields()) {
    if (field.is_required || (field.type != FieldType::number && field.type != FieldType::vec2)) continue;
    list.push_back(line(field, value_for(field, 1)));
    all += list.back();
  }
  list.push_back(all);
  return list;
}

// Replaces the number in a channel name such as "edge_force_3" by N.
std::string general_name(std::string name) {
  for (std::size_t i = 1; i < name.size(); ++i) {
    if (std::isdigit(static_cast<unsigned char>(name[i])) == 0 || name[i - 1] != '_') continue;
    std::size_t end = i;
    while (end < name.size() && std::isdigit(static_cast<unsigned char>(name[end])) != 0) ++end;
    name.replace(i, end - i, "N");
  }
  return name;
}

void enter(const Channel& channel, const std::string& name, std::vector<KindChannel>& list) {
  auto known = std::find_if(list.begin(), list.end(), [&](const KindChannel& c) { return c.name == name; });
  if (known == list.end()) {
    list.push_back({name, {}, channel.doc, channel.sign, channel.codes, channel.is_on_request});
    known = list.end() - 1;
  }
  if (std::find(known->units.begin(), known->units.end(), channel.unit) == known->units.end()) known->units.push_back(channel.unit);
}

// Adds the channels of the system whose names begin with `owner`, except those of its markers ("owner.a.x").
void enter_all(const System& system, const std::string& owner, std::vector<KindChannel>& list) {
  for (const Channel& channel : system.channels)
    if (channel.name.starts_with(owner + ".") && channel.name.find('.', owner.size() + 1) == std::string::npos)
      enter(channel, general_name(channel.name.substr(owner.size() + 1)), list);
}

// Compiles a model and adds the channels of its elements of this kind. Throws ModelError if the model is invalid.
void enter_scene(const std::string& text, const Catalogue& catalogue, const std::string& kind, std::vector<KindChannel>& list) {
  const std::unique_ptr<System> system = compile(parse_model(text, "example.toml", catalogue));
  for (std::size_t e = 0; e < system->element_names.size(); ++e)
    if (system->element_kinds[e] == kind) enter_all(*system, system->element_names[e], list);
}

void try_scene(const std::string& text, const Catalogue& catalogue, const std::string& kind, std::vector<KindChannel>& list) {
  try {
    enter_scene(text, catalogue, kind, list);
  } catch (const ModelError&) { // values that do not fit together; other samples are valid
  }
}

std::vector<KindChannel> sorted(std::vector<KindChannel> list) {
  std::stable_partition(list.begin(), list.end(), [](const KindChannel& c) { return !c.is_on_request; });
  return list;
}

std::vector<KindChannel> channels_in_scene(const Catalogue& catalogue, const std::string& owner) {
  std::vector<KindChannel> list;
  enter_all(*compile(parse_model(k_scene, "example.toml", catalogue)), owner, list);
  return list;
}

} // namespace

std::vector<KindChannel> channels_of_kind(const Catalogue& catalogue, const ElementKind& kind) {
  std::vector<KindChannel> list;
  if (!kind.compile) return list;
  const std::string head = std::string(k_scene) + k_signal + "[[element]]\nname = \"e\"\nkind = \"" + kind.name + "\"\n" +
                           required_fields(kind) + (kind.fields.find("b") && !is_required(kind, "b") ? "b = \"b\"\n" : "");
  for (const std::string& choice : choices_of(kind))
    for (const std::string& extra : extras_of(kind)) try_scene(head + choice + extra, catalogue, kind.name, list);
  enter_scene(example_model(kind), catalogue, kind.name, list);
  return sorted(std::move(list));
}

std::vector<KindChannel> channels_of_bodies(const Catalogue& catalogue) { return channels_in_scene(catalogue, "a"); }
std::vector<KindChannel> channels_of_markers(const Catalogue& catalogue) { return channels_in_scene(catalogue, "M"); }
std::vector<KindChannel> channels_of_model(const Catalogue& catalogue) { return channels_in_scene(catalogue, "whole"); }

std::string example_model(const ElementKind& kind) { return k_scene + kind.example; }

std::string example_text(const ElementKind& kind) {
  const std::string heading = "\nkind = '" + kind.name + "'\n";
  const std::size_t next = kind.example.find("\n[[", kind.example.find(heading));
  return next == std::string::npos ? kind.example : kind.example.substr(0, next + 1);
}

std::string units_text(const KindChannel& channel) {
  std::string text;
  for (const std::string& unit : channel.units) text += (text.empty() ? "" : " or ") + (unit.empty() ? std::string("-") : unit);
  return text;
}

} // namespace steplap
