// For models made in code: entries that are filled in where they stand.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <utility>

namespace steplap {

/// Adds an element with the defaults of its kind, to be filled in. `Held` is the struct that the kind's header
/// declares beside it (SpringDamper for spring_damper_kind()); any other throws std::bad_cast. What is returned stays
/// where it is while the entry stays in the model.
template <class Held> Held& add_element(Model& model, const ElementKind& kind, std::string name) {
  auto element = kind.create();
  Held& held = dynamic_cast<Held&>(*element);
  held.name = std::move(name);
  model.elements.emplace_back(&kind, std::move(element));
  return held;
}

/// Adds a signal of one of the kernel's kinds (signal_kinds(): "haversine", "harmonics", …), whose fields are set by
/// their paths: set_value(model, "signal.<name>.peak", 5.9) (model_path.h). Throws ModelError for an unknown kind.
void add_signal(Model& model, const std::string& kind, std::string name);

} // namespace steplap
