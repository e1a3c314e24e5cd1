// One model, many values: systems of a model as given, with some of its numbers changed.
#pragma once

#include "mbd/system/system.h"

#include <string>
#include <utility>
#include <vector>

namespace steplap {

/// A path (model_path.h) and the number it is to have, in SI.
using ModelValues = std::vector<std::pair<std::string, double>>;

/// A system of `given` with `values`, which does not refer to the model; `given` stays as it is. Reads no text and no
/// file. Throws ModelError for what is wrong with a path, a value or the model. May be called from several threads.
[[nodiscard]] std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values);

} // namespace steplap
