// JSON Schema (draft 2020-12) of model files, for completion and checks in TOML editors.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Returns the schema, generated from the field tables of the catalogue. A schema cannot check references, units and `extends`. Files that
/// extend others must pass too, so no field except `name` is required.
[[nodiscard]] std::string json_schema(const Catalogue& catalogue);

/// Returns the schema for the value of one field as JSON text. Used for other kinds of file that are read through field tables.
[[nodiscard]] std::string field_json_schema(const Field& field);

} // namespace steplap
