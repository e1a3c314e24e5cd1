// A signal of one of the kernel's kinds, its fields given by name.
#pragma once

#include "mbd/model/signal.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace steplap::testing {

using FieldValues = std::vector<std::pair<std::string, FieldValue>>;

inline Signal made_signal(const std::string& kind_name, const FieldValues& values) {
  for (const SignalKind* kind : signal_kinds()) {
    if (kind->name != kind_name) continue;
    const auto definition = kind->create();
    definition->name = "s";
    for (const auto& [field, value] : values) kind->fields.find(field)->set(definition.get(), value);
    return kind->build(*definition);
  }
  throw std::logic_error("no kind of signal " + kind_name);
}

} // namespace steplap::testing
