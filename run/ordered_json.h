// JSON whose objects keep the order of their entries, for objects of many entries: the library's own way to add or to read
// an entry looks through all before it, which for the channels of ten thousand bodies takes seconds.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace steplap {

/// An object that keeps the order of its entries.
using OrderedJson = nlohmann::ordered_json;

/// A new entry at the end of an object that has none of that name.
OrderedJson& append(OrderedJson& object, std::string name);

/// Reads text in which the names of an object differ. Discarded (is_discarded()) if it is no JSON.
[[nodiscard]] OrderedJson parse_ordered(const std::string& text);

} // namespace steplap
