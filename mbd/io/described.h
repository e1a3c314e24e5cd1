// Everything in a model file that has a field table, with its default values: what the reference
// and the schema are generated from.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

struct Described {
  std::string role; ///< "element", "signal", "table" ([[name]]), "settings" ([name]), "model" (top level) or
                    ///< "common" (what every element has)
  std::string name;
  std::string doc;
  const FieldTable* fields = nullptr;
  std::shared_ptr<const void> defaults; ///< an object as created

  /// The default of a field as TOML, "" if it has none.
  [[nodiscard]] std::string default_text(const Field& field) const;
};

[[nodiscard]] Described describe_common_fields();
[[nodiscard]] std::vector<Described> describe(const Catalogue& catalogue);
/// "number", "[x, y]", "marker", ...
[[nodiscard]] std::string type_text(const Field& field);

} // namespace steplap
