// All tables of a model file that have a field table, with their default values. The reference and the JSON Schema are generated from this
// list.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Described {
  std::string role; ///< "element", "signal", "table" ([[name]]), "settings" ([name]), "model" (top level) or "common" (fields of all
                    ///< elements)
  std::string name;
  std::string doc;
  const FieldTable* fields = nullptr;
  std::shared_ptr<const void> defaults; ///< object with default values

  /// Returns the default value of a field as TOML text, "" if it has none.
  [[nodiscard]] std::string default_text(const Field& field) const;
};

[[nodiscard]] Described describe_common_fields();
[[nodiscard]] std::vector<Described> describe(const Catalogue& catalogue);
/// Returns the type of a field as text: "number", "[x, y]", "marker", ...
[[nodiscard]] std::string type_text(const Field& field);

} // namespace steplap
