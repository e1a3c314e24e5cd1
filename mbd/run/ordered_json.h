// JSON objects that keep the order of their entries. Access through nlohmann::ordered_json compares all earlier names at each access, which
// takes seconds for the channels of ten thousand bodies; the functions below avoid this.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace steplap {

/// A JSON object that keeps the order of its entries.
using OrderedJson = nlohmann::ordered_json;

/// Returns an empty object with capacity for `entries`. Without capacity the library copies the object at each doubling, because it cannot
/// move entries with constant names.
[[nodiscard]] OrderedJson object_with_room(std::size_t entries);

/// Appends an entry. Precondition: the object has no entry of that name.
OrderedJson& append(OrderedJson& object, std::string name);

/// Parses text whose objects have unique names. The result is discarded (is_discarded()) if the text is not JSON.
[[nodiscard]] OrderedJson parse_ordered(const std::string& text);

} // namespace steplap
