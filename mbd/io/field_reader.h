// One table of a model file read into one object through its field table: types, units, unknown and
// missing keys. Ranges and references are left to validate().
#pragma once

#include "mbd/io/toml_text.h"
#include "mbd/model/fields.h"

#include <functional>

namespace steplap {

class ParametersReader;
struct RenamedKey;

/// A field as a file gives it; without a node it is required, but missing.
struct GivenField {
  const Field* field = nullptr;
  const Node* node = nullptr;
  bool is_usable = true; ///< false: its error is reported already
};

struct TableReading {
  std::string subject;                          ///< what messages call the object: "body 'tank'"
  std::vector<std::string> known_keys;          ///< read by the caller: "name", "kind"
  std::function<bool(const Field&)> is_excused; ///< required fields that may be missing all the same
  /// Makes a marker of an inline table { body, point | at, angle } and returns its name.
  std::function<std::string(const Node& table, const Field& field)> add_marker;
  ParametersReader* parameters = nullptr;     ///< gives formulas their values; null where there are none
  std::vector<RenamedKey>* renamed = nullptr; ///< takes keys with earlier names; null: such keys are read without a word
};

/// Sets the members of `object` that `table` gives; returns what it found. Problems are appended.
std::vector<GivenField> read_fields(const Node& table, const FieldTable& fields, void* object, const TableReading& reading,
                                    std::vector<Diagnostic>& problems);

/// What a value of the field looks like: "a number or a string with a unit like 'kg'".
[[nodiscard]] std::string expected_text(const Field& field);

} // namespace steplap
