// Tables that are expanded to bodies. For example, one elastic beam of a model file becomes many rigid segments.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Base class of tables that add bodies. Other entries of the model may refer to the bodies, markers and elements that they add.
struct BodyBuilder : TableObject {
  /// Adds bodies, markers and elements to the model and changes nothing else. Called during completion, before joints determine the
  /// positions of bodies, since these joints may be attached to the added bodies. Precondition: fields are within their ranges. Throws
  /// ModelError with all errors found.
  virtual void add_bodies(Model& model) const = 0;
};

/// Returns the table if it adds bodies, otherwise nullptr.
[[nodiscard]] inline const BodyBuilder* body_builder(const TableEntry& entry) {
  return dynamic_cast<const BodyBuilder*>(entry.table.get());
}

} // namespace steplap
