#include "mbd/io/json_schema.h"

#include "mbd/io/described.h"
#include "mbd/io/repetition.h"
#include "mbd/model/field_units.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

using Json = nlohmann::ordered_json;

Json quantity(const Field& field, const std::string& unit) {
  Json number{{"type", "number"}};
  if (std::isfinite(field.minimum))
    number[field.is_minimum_excluded ? "exclusiveMinimum" : "minimum"] = field.minimum;
  if (std::isfinite(field.maximum)) number["maximum"] = field.maximum;
  const char* const pattern = unit.empty() ? "^\\s*=" : "^\\s*([-+]?[0-9.]|=)"; // a formula of parameters, a number with its unit
  return {{"anyOf", {number, {{"type", "string"}, {"pattern", pattern}}}}};
}

Json list_of(Json items) {
  return {{"type", "array"}, {"items", std::move(items)}};
}

Json point(const Field& field) {
  const std::string& unit_y = field.unit2.empty() ? field.unit : field.unit2;
  return {{"type", "array"},
          {"prefixItems", {quantity(field, field.unit), quantity(field, unit_y)}},
          {"minItems", 2},
          {"maxItems", 2}};
}

Json text() {
  return {{"type", "string"}};
}

Json value_schema(const Field& field) {
  switch (field.type) {
  case FieldType::number:
    return quantity(field, field.unit);
  case FieldType::quantity:
    return quantity(field, "*");
  case FieldType::integer: {
    Json schema = quantity(field, "");
    schema["anyOf"][0]["type"] = "integer";
    return schema;
  }
  case FieldType::boolean:
    return {{"type", "boolean"}};
  case FieldType::choice:
    return {{"enum", field.choices}};
  case FieldType::vec2:
    return point(field);
  case FieldType::numbers:
    return list_of(quantity(field, field.unit));
  case FieldType::points:
    return list_of(point(field));
  case FieldType::rings:
    return list_of(list_of(point(field)));
  case FieldType::signals:
  case FieldType::elements:
  case FieldType::texts:
    return list_of(text());
  case FieldType::marker:
    return {{"anyOf", {text(), {{"$ref", "#/$defs/inline_marker"}}}}};
  default:
    return text();
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
  for (const Field& field : kind.fields->fields())
    properties[field.name] = field_schema(kind, field);
  return {{"type", "object"},
          {"description", kind.doc},
          {"properties", std::move(properties)},
          {"additionalProperties", false}};
}

const Described& common_fields() {
  static const Described common = describe_common_fields();
  return common;
}

// What files that extend another may say of a table.
void add_merging(Json& properties) {
  properties["unset"] = list_of(text());
  properties["unset"]["description"] = "inherited keys that are dropped";
  properties["replace"] = {{"type", "boolean"}, {"description", "drops all inherited keys"}};
}

// An entry of an array of tables: what it says, its name and what merging understands.
Json entry_schema(const Described& kind, bool has_kind) {
  Json schema = object_schema(kind);
  Json& properties = schema["properties"];
  if (!properties.contains("name")) properties["name"] = text();
  if (has_kind) properties["kind"] = {{"const", kind.name}};
  if (kind.role == "element")
    for (const Field& field : common_fields().fields->fields())
      properties[field.name] = field_schema(common_fields(), field);
  properties["remove"] = {{"type", "boolean"}, {"description", "takes the inherited entry out"}};
  add_merging(properties);
  schema["required"] = Json::array({"name"});
  return schema;
}

Json parameter_value() { return {{"anyOf", {{{"type", "number"}}, {{"type", "string"}, {"pattern", "^\\s*([-+]?[0-9.]|=)"}}}}}; }

// What is written out before anything is read: parts, and entries that are repeated.
void add_writing_out(Json& properties, const std::string& array) {
  const auto& repeated = repeated_arrays();
  if (std::find(repeated.begin(), repeated.end(), array) == repeated.end()) return;
  properties["repeat"] = {{"type", "integer"},
                          {"minimum", 0},
                          {"maximum", k_most_entries},
                          {"description", "so many entries, with the index i from 0 in formulas, \"= i * '0.6 m'\", and in names, \"sleeper {i+1}\""}};
  if (array == "part")
    properties["parameters"] = {{"type", "object"}, {"description", "values that the [parameters] of its file get"}, {"additionalProperties", parameter_value()}};
}

Json inline_marker_schema(const Described& marker) {
  Json schema = object_schema(marker);
  schema["required"] = Json::array({"body"});
  return schema;
}

Json parameters_schema() {
  const Json value = parameter_value();
  const Json full{{"type", "object"},
                  {"properties", {{"value", value}, {"range", {{"type", "array"}, {"items", value}, {"minItems", 2}, {"maxItems", 2}}}, {"meaning", text()}}},
                  {"additionalProperties", false}};
  return {{"type", "object"},
          {"description", "numbers with a name, for formulas in fields: \"= 2*wall + bore\""},
          {"additionalProperties", {{"anyOf", {value["anyOf"][0], value["anyOf"][1], full}}}}};
}

} // namespace

std::string json_schema(const Catalogue& catalogue) {
  Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
            {"title", "steplap model"}};
  Json properties = Json::object(), definitions = Json::object();
  Json kinds{{"signal", Json::array()}, {"element", Json::array()}};
  properties["extends"] = {{"type", "string"},
                           {"description", "model file that this one is laid over"}};
  properties["parameters"] = parameters_schema();
  for (const Described& kind : describe(catalogue)) {
    if (kind.role == "model") {
      for (const Field& f : kind.fields->fields())
        properties[f.name] = field_schema(kind, f);
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
      kinds[kind.role].push_back({{"$ref", "#/$defs/" + kind.role + "_" + kind.name}});
    }
  }
  for (const std::string role : {"signal", "element"})
    if (!kinds[role].empty()) properties[role] = list_of({{"anyOf", kinds[role]}});
  root["type"] = "object";
  root["properties"] = std::move(properties);
  root["additionalProperties"] = false;
  root["$defs"] = std::move(definitions);
  return root.dump(2) + "\n";
}

std::string field_json_schema(const Field& field) {
  Json schema = value_schema(field);
  schema["description"] = field.unit.empty() || field.unit == "*" ? field.doc : field.doc + " [" + shown_unit(field) + "]";
  return schema.dump();
}

} // namespace steplap
