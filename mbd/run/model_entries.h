// Lists all tables of a model with their fields and the paths to them (mbd/model/model_path.h).
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// A table of a model.
struct ModelEntry {
  std::string path;                   ///< "body.tank"; "" for the top level
  std::string kind;                   ///< kind of an element or signal; "" for others
  const FieldTable* fields = nullptr; ///< field descriptions; never nullptr in the result of entries_of()
  const FieldTable* common = nullptr; ///< fields shared by all entries of the array, or nullptr
  const void* object = nullptr;       ///< the object to which the fields belong; owned by the model
};

/// Returns the entries in model order: top level, [simulation], [output], bodies, markers, signals, elements, tables.
[[nodiscard]] std::vector<ModelEntry> entries_of(const Model& model);

} // namespace steplap
