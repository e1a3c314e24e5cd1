// All that has fields in a model, with the paths that lead to them (mbd/model/model_path.h).
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Something with fields, and how paths begin that lead to them.
struct ModelEntry {
  std::string path;                   ///< "body.tank"; "" of the top level
  std::string kind;                   ///< of an element or a signal; "" of others
  const FieldTable* fields = nullptr; ///< never nullptr of an entry that entries_of() gives
  const FieldTable* common = nullptr; ///< fields that all entries of the array have besides, or nullptr
  const void* object = nullptr;       ///< whose fields they are: lives as long as the model
};

/// In the order in which models hold them: top level, [simulation], [output], bodies, markers, signals, elements, tables.
[[nodiscard]] std::vector<ModelEntry> entries_of(const Model& model);

} // namespace steplap
