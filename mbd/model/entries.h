// Selects the elements and tables of a model that belong to one kind, by the struct of the kind.
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap {

/// Returns the elements that are a T, in the order of the model.
template <class T> [[nodiscard]] std::vector<const T*> elements_of(const Model& model) {
  std::vector<const T*> found;
  for (const ElementEntry& entry : model.elements)
    if (const auto* const one = dynamic_cast<const T*>(entry.element.get())) found.push_back(one);
  return found;
}
/// Returns the elements that are a T, for changes.
template <class T> [[nodiscard]] std::vector<T*> elements_of(Model& model) {
  std::vector<T*> found;
  for (ElementEntry& entry : model.elements)
    if (auto* const one = dynamic_cast<T*>(entry.element.get())) found.push_back(one);
  return found;
}
/// Returns the tables, such as [[core]], that are a T, in the order of the model.
template <class T> [[nodiscard]] std::vector<const T*> tables_of(const Model& model) {
  std::vector<const T*> found;
  for (const TableEntry& entry : model.tables)
    if (const auto* const one = dynamic_cast<const T*>(entry.table.get())) found.push_back(one);
  return found;
}
/// Returns the tables that are a T, for changes.
template <class T> [[nodiscard]] std::vector<T*> tables_of(Model& model) {
  std::vector<T*> found;
  for (TableEntry& entry : model.tables)
    if (auto* const one = dynamic_cast<T*>(entry.table.get())) found.push_back(one);
  return found;
}

} // namespace steplap
