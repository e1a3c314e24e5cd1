// The signals of a model, which may be made of one another.
#pragma once

#include "mbd/model/model.h"

#include <unordered_map>

namespace steplap {

/// Builds every signal once, after those that it is made of.
class SignalNetwork {
public:
  /// Refers to the model's signals, of which none may be added later.
  explicit SignalNetwork(const Model& model);

  /// Null if there is none of that name, or if it or one that it is made of is excluded or has failed before. Throws
  /// ModelError for values that make no signal, and for one that is made of itself.
  const Signal* build(const std::string& name);
  /// Its error is reported already.
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
  std::vector<const Item*> chain_; ///< begun, each made of the next
};

/// The names that its fields of the types signal and signals hold, in their order.
[[nodiscard]] std::vector<std::string> parts_of(const FieldTable& fields, const void* object);

} // namespace steplap
