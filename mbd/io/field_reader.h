// Reads one table of a model file into one object through its field table: types, units, unknown and missing keys. Ranges and references
// are checked by validate().
#pragma once

#include "mbd/io/toml_text.h"
#include "mbd/model/fields.h"

#include <functional>

namespace steplap {

class ParametersReader;
struct RenamedKey;

/// A field found in a table. `node` is null for a required field that is missing.
struct GivenField {
  const Field* field = nullptr;
  const Node* node = nullptr;
  bool is_usable = true; ///< false: an error was already reported
};

struct TableReading {
  std::string subject;                          ///< name of the object in messages: "body 'tank'"
  std::vector<std::string> known_keys;          ///< keys that the caller reads: "name", "kind"
  bool knows_all_keys = false;                  ///< every key belongs to a field or is reported by another reading of the table
  std::function<bool(const Field&)> is_excused; ///< returns true for required fields that may be missing here
  /// Creates a marker from an inline table { body, point | at, angle } and returns its name.
  std::function<std::string(const Node& table, const Field& field)> add_marker;
  ParametersReader* parameters = nullptr;     ///< evaluates formulas; null if formulas are not allowed
  std::vector<RenamedKey>* renamed = nullptr; ///< collects keys that have an earlier name; if null, such keys are read silently
};

/// Sets the members of `object` whose fields `table` contains. Returns the fields found. Appends errors to `problems`.
std::vector<GivenField> read_fields(const Node& table, const FieldTable& fields, void* object, const TableReading& reading,
                                    std::vector<Diagnostic>& problems);

/// Returns the expected form of a value as text: "a number or a string with a unit like 'kg'".
[[nodiscard]] std::string expected_text(const Field& field);

} // namespace steplap
