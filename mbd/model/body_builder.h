// A table that stands for bodies of the model: an elastic beam is one entry of a file, and many rigid segments of a scene.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// A table whose bodies, markers and elements the others may refer to.
struct BodyBuilder : TableObject {
  /// Adds them and changes nothing else. Called when a model is completed, before joints place bodies, for the joints may hold what is
  /// added here. Fields are within their ranges. Throws ModelError with all that is wrong.
  virtual void add_bodies(Model& model) const = 0;
};

/// Null where a table adds no bodies.
[[nodiscard]] inline const BodyBuilder* body_builder(const TableEntry& entry) {
  return dynamic_cast<const BodyBuilder*>(entry.table.get());
}

} // namespace steplap
