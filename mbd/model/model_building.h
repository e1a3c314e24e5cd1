// Functions that add entries to a model in C++ code.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <utility>

namespace steplap {

/// Adds an element with the default values of its kind. Returns a reference that is valid while the entry is in the model. `Held` is the
/// struct of the kind, such as SpringDamper for spring_damper_kind(); another type throws std::bad_cast.
template <class Held> Held& add_element(Model& model, const ElementKind& kind, std::string name) {
  auto element = kind.create();
  Held& held = dynamic_cast<Held&>(*element);
  held.name = std::move(name);
  model.elements.emplace_back(&kind, std::move(element));
  return held;
}

/// Adds a signal of one of the kinds in signal_kinds() ("haversine", "harmonics", …). Set its fields by path: set_value(model,
/// "signal.<name>.peak", 5.9) (model_path.h). Throws ModelError for an unknown kind.
void add_signal(Model& model, const std::string& kind, std::string name);

} // namespace steplap
