#include "mbd/model/field_units.h"

namespace steplap {

namespace {

std::string choice_of(const FieldTable& table, const char* name, const void* object) {
  const Field* const field = table.find(name);
  if (!field || field->type != FieldType::choice) return "";
  const FieldValue value = field->get(object);
  const auto* const text = std::get_if<std::string>(&value);
  return text ? *text : "";
}

} // namespace

bool depends_on_other_fields(const Field& field) { return field.unit.find('|') != std::string::npos; }

std::string unit_in(const FieldTable& table, const Field& field, const void* object) {
  const std::size_t bar = field.unit.find('|');
  if (bar == std::string::npos) return field.unit;
  std::string unit = choice_of(table, "coordinate", object) == "angle" ? field.unit.substr(0, bar) : field.unit.substr(bar + 1);
  const std::string as = choice_of(table, "as", object);
  if (as == "velocity") unit += "/s";
  if (as == "acceleration") unit += "/s^2";
  return unit;
}

std::string shown_unit(const Field& field) {
  std::string text = field.unit;
  if (const std::size_t bar = text.find('|'); bar != std::string::npos) text.replace(bar, 1, " or ");
  return text;
}

} // namespace steplap
