#include "mbd/model/signal_network.h"

#include "mbd/base/number_text.h"
#include "mbd/model/validate.h"

#include <stdexcept>

namespace steplap {

std::vector<std::string> parts_of(const FieldTable& fields, const void* object) {
  std::vector<std::string> names;
  for (const Field& field : fields.fields()) {
    if (field.type != FieldType::signal && field.type != FieldType::signals) continue;
    const FieldValue value = field.get(object);
    if (const auto* list = std::get_if<std::vector<std::string>>(&value)) names.insert(names.end(), list->begin(), list->end());
    else if (const auto& name = std::get<std::string>(value); !name.empty()) names.push_back(name);
  }
  return names;
}

namespace {

// Name of the field for the speed in signals that depend on position. A signal that combines a single other one uses the speed of that one.
constexpr const char* k_speed = "speed";

template <class Items> std::optional<double> speed_of(const Items& items, const std::string& name) {
  const SignalEntry& entry = *items.at(name).entry;
  const Field* const field = entry.kind->fields.find(k_speed);
  if (!field) return std::nullopt;
  const FieldValue value = field->get(entry.definition.get());
  if (const double* given = std::get_if<double>(&value)) return *given;
  const std::vector<std::string> parts = parts_of(entry.kind->fields, entry.definition.get());
  return parts.size() == 1 ? speed_of(items, parts.front()) : std::nullopt;
}

// Returns the definition; if it has a speed field that is not given, with the speed of the signal to which it refers.
template <class Items> std::shared_ptr<const SignalDefinition> completed(const Items& items, const SignalEntry& entry) {
  const Field* const field = entry.kind->fields.find(k_speed);
  const std::vector<std::string> parts = parts_of(entry.kind->fields, entry.definition.get());
  const std::optional<double> speed = field && parts.size() == 1 ? speed_of(items, parts.front()) : std::nullopt;
  if (!speed) return entry.definition;
  const FieldValue value = field->get(entry.definition.get());
  const double* const given = std::get_if<double>(&value);
  if (given && *given != *speed)
    throw ModelError(entry.definition->where, subject_text(entry.kind->name, entry.definition->name) + ": 'speed' is " +
                                                  number_text(*given) + " m/s, but that of its signal '" + parts.front() + "' is " +
                                                  number_text(*speed) + " m/s: leave it out");
  if (given) return entry.definition;
  const auto copy = entry.kind->copy(*entry.definition);
  field->set(copy.get(), *speed);
  return copy;
}

} // namespace

SignalNetwork::SignalNetwork(const Model& model) {
  for (const SignalEntry& entry : model.signals) items_.try_emplace(entry.definition->name, Item{&entry, {}, {}});
}

void SignalNetwork::exclude(const std::string& name) { items_[name].status = Status::failed; }

void SignalNetwork::fail_in_a_circle(const Item& item) const {
  const SignalDefinition& definition = *item.entry->definition;
  std::string circle = "'" + definition.name + "'";
  bool is_inside = false;
  for (const Item* link : chain_) {
    if (is_inside) circle += " -> '" + link->entry->definition->name + "'";
    is_inside = is_inside || link == &item;
  }
  throw ModelError(definition.where, "signal '" + definition.name + "' is made of itself: " + circle + " -> '" + definition.name + "'");
}

const Signal* SignalNetwork::build(const std::string& name) {
  const auto found = items_.find(name);
  return found == items_.end() ? nullptr : build(found->second);
}

const Signal* SignalNetwork::build(Item& item) {
  if (item.status == Status::built) return &item.signal;
  if (item.status == Status::failed) return nullptr;
  if (item.status == Status::begun) fail_in_a_circle(item);
  const SignalKind& kind = *item.entry->kind;
  const SignalDefinition& definition = *item.entry->definition;
  const std::size_t depth = chain_.size();
  chain_.push_back(&item);
  item.status = Status::begun;
  try {
    bool is_complete = true;
    std::vector<const Signal*> parts;
    const std::vector<std::string> names = kind.combine ? parts_of(kind.fields, &definition) : std::vector<std::string>();
    for (const std::string& name : names) {
      parts.push_back(build(name));
      is_complete = is_complete && parts.back();
    }
    if (is_complete) item.signal = kind.combine ? kind.combine(*completed(items_, *item.entry), parts) : kind.build(definition);
    // A delay is not taken into account: with it a doubt may be raised too early.
    for (std::size_t k = 0; k < names.size() && is_complete; ++k)
      for (const Signal::Doubt& doubt : parts[k]->doubts()) item.signal.add_doubt(doubt.t, "in '" + names[k] + "', " + doubt.text);
    item.status = is_complete ? Status::built : Status::failed;
  } catch (const std::exception& error) {
    item.status = Status::failed;
    chain_.resize(depth);
    if (!dynamic_cast<const std::invalid_argument*>(&error)) throw;
    throw ModelError(definition.where, subject_text(kind.name, definition.name) + ": " + error.what());
  }
  chain_.resize(depth);
  return item.status == Status::built ? &item.signal : nullptr;
}

} // namespace steplap
