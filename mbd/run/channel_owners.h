// Bodies and elements to which a channel belongs.
#pragma once

#include "mbd/model/model.h"

#include <set>
#include <string>
#include <vector>

namespace steplap {

/// Returns the owner of a channel, its name up to the last point: "box" of "box.x".
[[nodiscard]] std::string owner_of(const std::string& channel);
/// Returns the owners of a channel and, if it is a formula, of all channels that it uses directly or through other formulas.
[[nodiscard]] std::set<std::string> owners_of(const Model& model, const std::string& channel);
/// Returns the moving bodies that an element connects.
[[nodiscard]] std::vector<std::string> bodies_of(const Model& model, const ElementEntry& entry);

} // namespace steplap
