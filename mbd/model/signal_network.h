// Builds the signals of a model, including those that refer to other signals.
#pragma once

#include "mbd/model/model.h"

#include <unordered_map>

namespace steplap {

/// Builds each signal once, after the signals that it refers to.
class SignalNetwork {
public:
  /// Keeps references to the signals of `model`; none may be added later.
  explicit SignalNetwork(const Model& model);

  /// Returns the signal; the first call builds it and those to which it refers. Returns null if the name is unknown, or if the signal or
  /// one of those is excluded or has failed before. Throws ModelError if its values do not define a signal, or if it refers to itself.
  const Signal* build(const std::string& name);
  /// Marks a signal as unusable because its error has already been reported.
  void exclude(const std::string& name);

private:
  enum class Status { untouched, begun, built, failed };
  struct Item {
    const SignalEntry* entry = nullptr;
    Status status = Status::untouched;
    Signal signal;
  };
  const Signal* build(Item& item);
  [[noreturn]] void fail_in_a_circle(const Item& item) const;

  std::unordered_map<std::string, Item> items_;
  std::vector<const Item*> chain_; ///< signals being built, each referring to the next; used to detect cycles
};

/// Returns the signal names in the object's fields of types signal and signals, in order.
[[nodiscard]] std::vector<std::string> parts_of(const FieldTable& fields, const void* object);

} // namespace steplap
