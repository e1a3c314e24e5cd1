// Lists the loads of a model in a run, for readers of a sheet.
#pragma once

#include "mbd/run/ordered_json.h"

#include <string>

namespace steplap {

/// Returns rows [name, text]: gravity and initial velocity if the model states them, elements that `drawing` (run/drawing.h) shows as loads
/// or drives, signals that something refers to, with their fields, and the source of the values. `model_text` is the effective model (model.toml); numbers
/// without a unit are SI. Throws ModelError if it is not TOML.
[[nodiscard]] OrderedJson load_case_json(const std::string& model_text, const OrderedJson& drawing);

} // namespace steplap
