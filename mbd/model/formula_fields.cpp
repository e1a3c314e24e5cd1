#include "mbd/model/formula_fields.h"

#include "mbd/formula/formula.h"

namespace steplap {

bool is_formula_key(const std::string& name) { return name == "formula" || name == "rate" || name == "when"; }

bool is_formula_field(const Field& field) { return field.type == FieldType::text && is_formula_key(field.name); }

bool is_own_name(const std::string& name) { return name == "value" || name == "rate"; }

std::vector<std::string> names_in_formulas(const ElementEntry& entry) {
  std::vector<std::string> names;
  for (const Field& field : entry.kind->fields.fields()) {
    if (!is_formula_field(field)) continue;
    try {
      const Formula formula(std::get<std::string>(field.get(entry.element.get())), field.name, {});
      names.insert(names.end(), formula.names().begin(), formula.names().end());
    } catch (const ModelError&) { // the error is reported when the element is compiled
    }
  }
  return names;
}

} // namespace steplap
