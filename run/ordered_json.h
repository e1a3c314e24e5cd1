// JSON whose objects keep the order of their entries, for objects of many entries: the library's own way to add or to read
// an entry looks through all before it, which for the channels of ten thousand bodies takes seconds.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

namespace steplap {

/// An object that keeps the order of its entries.
using OrderedJson = nlohmann::ordered_json;

/// An empty object with room for so many entries. One that outgrows its room is copied with all that it holds, at each doubling: entries
/// have names that do not change, which the library cannot move.
[[nodiscard]] OrderedJson object_with_room(std::size_t entries);

/// A new entry at the end of an object that has none of that name.
OrderedJson& append(OrderedJson& object, std::string name);

/// Reads text in which the names of an object differ. Discarded (is_discarded()) if it is no JSON.
[[nodiscard]] OrderedJson parse_ordered(const std::string& text);

} // namespace steplap
