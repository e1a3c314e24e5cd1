#include "mbd/io/document.h"
#include "mbd/io/json_schema.h"
#include "tools/study/kinds.h"
#include "tools/study/study.h"

#include <nlohmann/json.hpp>

namespace steplap::study {

namespace {

using Json = nlohmann::ordered_json;

// Returns a schema that accepts no value, for unknown keys. Editors then mark the key; with "false" they mark the whole table.
const Json& no_other_keys() {
  static const Json schema{{"const", "a field that this table has"}};
  return schema;
}

// Returns true for keys that accept a text or a list of texts.
bool takes_one(const std::string& name) { return name == "model" || name == "path"; }

Json properties_of(const FieldTable& fields) {
  Json properties = Json::object();
  for (const Field& field : fields.fields()) {
    Json schema = Json::parse(field_json_schema(field));
    if (takes_one(field.name) && field.type == FieldType::texts)
      schema = {{"anyOf", Json::array({Json{{"type", "string"}}, schema})}, {"description", field.doc}};
    properties[field.name] = std::move(schema);
  }
  return properties;
}

Json required_of(const FieldTable& fields) {
  Json required = Json::array();
  for (const Field& field : fields.fields())
    if (field.is_required) required.push_back(field.name);
  return required;
}

Json object_schema(const StudyTable& table) {
  Json schema{{"type", "object"},
              {"description", table.doc},
              {"properties", properties_of(table.fields)},
              {"required", required_of(table.fields)},
              {"additionalProperties", no_other_keys()}};
  if (!table.is_array) return schema;
  return {{"type", "array"}, {"items", std::move(schema)}};
}

} // namespace

std::string study_schema() {
  Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "steplap study"}, {"type", "object"}};
  Json properties = Json::object();
  for (const StudyTable& table : study_tables()) {
    if (table.name.empty()) {
      properties = properties_of(table.fields);
      properties["kind"] = {{"enum", kind_names()}, {"description", "what is asked"}};
      properties["format"] = {{"const", k_file_format}, {"description", "version of the format of this file"}};
      properties["extends"] = {{"type", "string"}, {"description", "study file that this one is laid over"}};
      continue;
    }
    properties[table.name] = object_schema(table);
  }
  root["properties"] = std::move(properties);
  root["additionalProperties"] = no_other_keys();
  return root.dump(2) + "\n";
}

} // namespace steplap::study
