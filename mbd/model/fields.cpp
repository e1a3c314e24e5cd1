#include "mbd/model/fields.h"

namespace steplap {

const Field* FieldTable::find_earlier(const std::string& name) const {
  for (const Field& field : fields_)
    if (!name.empty() && field.earlier_name == name) return &field;
  return nullptr;
}

const Field* FieldTable::find(const std::string& name) const {
  for (const Field& field : fields_)
    if (field.name == name) return &field;
  return nullptr;
}

std::vector<std::string> FieldTable::names() const {
  std::vector<std::string> result;
  for (const Field& field : fields_) result.push_back(field.name);
  return result;
}

} // namespace steplap
