// JSON Schema (draft 2020-12) of model files, for editors that complete and check TOML.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Generated from the field tables of the catalogue. References between names, units and `extends`
/// are beyond a schema: files that extend others are checked as they stand, hence no field of an
/// entry but its name is required.
[[nodiscard]] std::string json_schema(const Catalogue& catalogue);

/// The schema of one field's value, as JSON text: for files of other kinds that are read through field tables.
[[nodiscard]] std::string field_json_schema(const Field& field);

} // namespace steplap
