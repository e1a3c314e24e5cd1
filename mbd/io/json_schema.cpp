#include "mbd/io/json_schema.h"

#include "mbd/io/described.h"
#include "mbd/io/document.h"
#include "mbd/io/repetition.h"
#include "mbd/model/field_units.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

// Returns the schema of a number with a unit. Limits apply to numbers and the pattern to texts in one schema, so that an editor names the
// violated rule. With "anyOf" it could only report that no alternative fits.
Json quantity(const Field& field, const std::string& unit, const char* number = "number") {
  Json schema{{"type", {number, "string"}}};
  if (std::isfinite(field.minimum)) schema[field.is_minimum_excluded ? "exclusiveMinimum" : "minimum"] = field.minimum;
  if (std::isfinite(field.maximum)) schema["maximum"] = field.maximum;
  schema["pattern"] = unit.empty() ? "^\\s*=" : "^\\s*([-+]?[0-9.]|=)"; // a formula, or a number with its unit
  return schema;
}

// Refuses keys that are not in `properties`. An impossible value is demanded of them, so that editors mark the key; with "false" they would
// mark the whole table.
void close(Json& schema) { schema["additionalProperties"] = {{"const", "a field that this table has"}}; }

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json point(const Field& field) {
  const std::string& unit_y = field.unit2.empty() ? field.unit : field.unit2;
  return {{"type", "array"}, {"prefixItems", {quantity(field, field.unit), quantity(field, unit_y)}}, {"minItems", 2}, {"maxItems", 2}};
}

Json text() { return {{"type", "string"}}; }

Json value_schema(const Field& field) {
  switch (field.type) {
  case FieldType::number: return quantity(field, field.unit);
  case FieldType::quantity: return quantity(field, "*");
  case FieldType::integer: return quantity(field, "", "integer");
  case FieldType::boolean: return {{"type", "boolean"}};
  case FieldType::choice: return {{"enum", field.choices}};
  case FieldType::vec2: return point(field);
  case FieldType::numbers: return list_of(quantity(field, field.unit));
  case FieldType::points: return list_of(point(field));
  case FieldType::rings: return list_of(list_of(point(field)));
  case FieldType::signals:
  case FieldType::elements:
  case FieldType::texts: return list_of(text());
  case FieldType::marker: return {{"anyOf", {text(), {{"$ref", "#/$defs/inline_marker"}}}}};
  default: return text();
  }
}

Json field_schema(const Described& kind, const Field& field) {
  Json schema = value_schema(field);
  std::string doc = field.doc;
  if (!field.unit.empty() && field.unit != "*") doc += " [" + shown_unit(field) + "]";
  schema["description"] = doc;
  if (field.is_required) return schema;
  const std::string given = kind.default_text(field);
  if (!given.empty()) schema["default"] = Json::parse(given, nullptr, false);
  if (given.empty() || schema["default"].is_discarded()) schema.erase("default");
  return schema;
}

Json object_schema(const Described& kind) {
  Json properties = Json::object();
  for (const Field& field : kind.fields->fields()) properties[field.name] = field_schema(kind, field);
  Json schema{{"type", "object"}, {"description", kind.doc}, {"properties", std::move(properties)}};
  close(schema);
  return schema;
}

const Described& common_fields() {
  static const Described common = describe_common_fields();
  return common;
}

// Adds the keys `unset` and `replace`, by which a file changes the entries that it inherits.
void add_merging(Json& properties) {
  properties["unset"] = list_of(text());
  properties["unset"]["description"] = "inherited keys that are dropped";
  properties["replace"] = {{"type", "boolean"}, {"description", "drops all inherited keys"}};
}

// Returns the schema of an entry of an array of tables: its fields, its name and the merge keys.
Json entry_schema(const Described& kind, bool has_kind) {
  Json schema = object_schema(kind);
  Json& properties = schema["properties"];
  if (!properties.contains("name")) properties["name"] = text();
  if (has_kind) properties["kind"] = {{"const", kind.name}};
  if (kind.role == "element")
    for (const Field& field : common_fields().fields->fields()) properties[field.name] = field_schema(common_fields(), field);
  properties["remove"] = {{"type", "boolean"}, {"description", "takes the inherited entry out"}};
  add_merging(properties);
  schema["required"] = Json::array({"name"});
  return schema;
}

Json parameter_value() { return {{"type", {"number", "string"}}, {"pattern", "^\\s*([-+]?[0-9.]|=)"}}; }

// Adds the keys that are expanded before fields are read: `repeat` of entries, and `repeat` and `parameters` of parts.
void add_writing_out(Json& properties, const std::string& array) {
  const auto& repeated = repeated_arrays();
  if (std::find(repeated.begin(), repeated.end(), array) == repeated.end()) return;
  properties["repeat"] = {
      {"type", "integer"},
      {"minimum", 0},
      {"maximum", k_most_entries},
      {"description", "so many entries, with the index i from 0 in formulas, \"= i * '0.6 m'\", and in names, \"sleeper {i+1}\""}};
  if (array == "part")
    properties["parameters"] = {
        {"type", "object"}, {"description", "values that the [parameters] of its file get"}, {"additionalProperties", parameter_value()}};
}

Json inline_marker_schema(const Described& marker) {
  Json schema = object_schema(marker);
  schema["required"] = Json::array({"body"});
  return schema;
}

Json parameters_schema() {
  const Json value = parameter_value();
  Json full = value; // or a table
  full["type"].push_back("object");
  full["properties"] = {
      {"value", value}, {"range", {{"type", "array"}, {"items", value}, {"minItems", 2}, {"maxItems", 2}}}, {"meaning", text()}};
  close(full);
  return {{"type", "object"},
          {"description", "numbers with a name, for formulas in fields: \"= 2*wall + bore\""},
          {"additionalProperties", std::move(full)}};
}

// Returns the descriptions of one field in several kinds: "stiffness [N/m] (tie, bushing); stiffness, turning [N m] (gear)". The kinds are
// left out if the description is the same for all.
std::string meanings(const std::vector<std::pair<std::string, std::string>>& docs, std::size_t all) {
  std::string text;
  for (std::size_t i = 0; i < docs.size(); ++i) {
    const auto same = [&docs, i](const auto& other) { return other.second == docs[i].second; };
    if (std::find_if(docs.begin(), docs.begin() + static_cast<std::ptrdiff_t>(i), same) != docs.begin() + static_cast<std::ptrdiff_t>(i))
      continue;
    std::string kinds;
    for (const auto& other : docs)
      if (same(other)) kinds += (kinds.empty() ? "" : ", ") + other.first;
    text += (text.empty() ? "" : "; ") + docs[i].second;
    if (static_cast<std::size_t>(std::count_if(docs.begin(), docs.end(), same)) < all) text += " (" + kinds + ")";
  }
  return text;
}

// Returns the schema of entries of several kinds. Conditions select the schema of the entry's kind, so that an editor reports errors at
// their line. All fields are listed again under "properties", because editors do not complete keys from conditions.
Json entries_of_kinds(const std::string& role, const Json& definitions) {
  const std::string prefix = role + "_";
  std::vector<std::string> kinds;
  std::vector<std::string> order;                                               // order of the fields
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> docs; // per field: kinds and meanings
  std::map<std::string, Json> values;                                           // per field: permitted values in any kind
  for (const auto& [name, definition] : definitions.items()) {
    if (!name.starts_with(prefix)) continue;
    kinds.push_back(name.substr(prefix.size()));
    for (const auto& [field, schema] : definition["properties"].items()) {
      if (field == "kind") continue;
      if (docs[field].empty()) order.push_back(field);
      docs[field].emplace_back(kinds.back(), schema.value("description", ""));
      Json value = schema;
      value.erase("description");
      value.erase("default");
      if (std::find(values[field].begin(), values[field].end(), value) == values[field].end()) values[field].push_back(std::move(value));
    }
  }
  Json offered{{"kind", {{"enum", kinds}, {"description", "what it is"}}}};
  Json known{{"kind", Json::object()}};
  for (const std::string& field : order) {
    offered[field] = {{"description", meanings(docs[field], kinds.size())}};
    known[field] = values[field].size() == 1 ? values[field].front() : Json{{"anyOf", values[field]}};
  }
  Json schema{{"properties", std::move(known)}}; // for entries without a kind, which change another file's entry
  close(schema);
  for (auto kind = kinds.rbegin(); kind != kinds.rend(); ++kind)
    schema = {{"if", {{"properties", {{"kind", {{"const", *kind}}}}}, {"required", Json::array({"kind"})}}},
              {"then", {{"$ref", "#/$defs/" + prefix + *kind}}},
              {"else", std::move(schema)}};
  schema["type"] = "object";
  schema["required"] = Json::array({"name"});
  schema["properties"] = std::move(offered);
  return schema;
}

} // namespace

std::string json_schema(const Catalogue& catalogue) {
  Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "steplap model"}};
  Json properties = Json::object(), definitions = Json::object();
  properties["format"] = {{"const", k_file_format}, {"description", "version of the format of this file"}};
  properties["outline_unit"] = {{"type", "string"},
                                {"description", "unit of plain numbers of the outlines and lengths of shapes in this file, as in \"mm\""}};
  properties["extends"] = {{"type", "string"}, {"description", "model file that this one is laid over"}};
  properties["parameters"] = parameters_schema();
  for (const Described& kind : describe(catalogue)) {
    if (kind.role == "model") {
      for (const Field& f : kind.fields->fields()) properties[f.name] = field_schema(kind, f);
    } else if (kind.role == "settings") {
      properties[kind.name] = object_schema(kind);
      add_merging(properties[kind.name]["properties"]);
    } else if (kind.role == "table") {
      Json entry = entry_schema(kind, false);
      add_writing_out(entry["properties"], kind.name);
      properties[kind.name] = list_of(std::move(entry));
      if (kind.name == "marker") definitions["inline_marker"] = inline_marker_schema(kind);
    } else if (kind.role != "common") {
      Json entry = entry_schema(kind, true);
      add_writing_out(entry["properties"], kind.role);
      definitions[kind.role + "_" + kind.name] = std::move(entry);
    }
  }
  for (const std::string role : {"signal", "element"}) properties[role] = list_of(entries_of_kinds(role, definitions));
  root["type"] = "object";
  root["properties"] = std::move(properties);
  close(root);
  root["$defs"] = std::move(definitions);
  return root.dump(2) + "\n";
}

std::string field_json_schema(const Field& field) {
  Json schema = value_schema(field);
  schema["description"] = field.unit.empty() || field.unit == "*" ? field.doc : field.doc + " [" + shown_unit(field) + "]";
  return schema.dump();
}

} // namespace steplap
