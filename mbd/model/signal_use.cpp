#include "mbd/model/signal_use.h"

#include "mbd/model/field_units.h"
#include "mbd/model/signal_composites.h"
#include "mbd/model/signal_network.h"

#include <algorithm>

namespace steplap {

namespace {

bool has_factors_but_one(const SignalEntry& entry) {
  for (const Field& field : entry.kind->fields.fields()) {
    if (!is_factor(field)) continue;
    const FieldValue value = field.get(entry.definition.get());
    if (const double* const factor = std::get_if<double>(&value); factor && *factor != 1.0) return true;
    if (const auto* const factors = std::get_if<std::vector<double>>(&value))
      if (std::any_of(factors->begin(), factors->end(), [](double factor) { return factor != 1.0; })) return true;
  }
  return false;
}

} // namespace

bool is_factor(const Field& field) { return field.name == "factor" || field.name == "factors"; }

bool is_in_unit_of_signal(const SignalKind& kind, const Field& field) { return field.unit == "*" && (!kind.combine || !is_factor(field)); }

std::vector<const SignalEntry*> signals_in_unit_of(const Model& model, const std::string& signal,
                                                   const std::function<bool(const SignalEntry&)>& has_factors) {
  std::vector<const SignalEntry*> found;
  std::vector<std::string> names{signal};
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto entry = std::find_if(model.signals.begin(), model.signals.end(),
                                    [&](const SignalEntry& each) { return each.definition->name == names[k]; });
    if (entry == model.signals.end() || std::find(found.begin(), found.end(), &*entry) != found.end()) continue;
    found.push_back(&*entry);
    if (entry->kind == &product_kind() || has_factors(*entry)) continue;
    const std::vector<std::string> parts = parts_of(entry->kind->fields, entry->definition.get());
    names.insert(names.end(), parts.begin(), parts.end());
  }
  return found;
}

std::string unit_taken(const Model& model, const std::string& signal) {
  std::string taken = "*";
  const auto look = [&](const FieldTable& table, const void* object) {
    for (const Field& field : table.fields()) {
      if (field.type != FieldType::signal) continue;
      const auto parts = signals_in_unit_of(model, std::get<std::string>(field.get(object)), has_factors_but_one);
      if (std::none_of(parts.begin(), parts.end(), [&](const SignalEntry* part) { return part->definition->name == signal; })) continue;
      const std::string unit = unit_in(table, field, object);
      taken = taken == "*" || taken == unit ? unit : "";
    }
  };
  for (const ElementEntry& entry : model.elements) look(entry.kind->fields, entry.element.get());
  for (const TableEntry& entry : model.tables) look(entry.kind->fields, entry.table.get());
  return taken;
}

} // namespace steplap
