// Lists the loads of a model, for the sheet of a run.
#pragma once

#include "mbd/run/ordered_json.h"

#include <string>

namespace steplap {

/// Returns rows [name, text]: gravity and initial velocity if the model gives them; elements that `drawing` (run/drawing.h) shows as loads
/// or drives; signals that are used, with their fields; and the source of the values. `model_text`: text of model.toml, whose numbers
/// without a unit are SI. Throws ModelError if it is not valid TOML.
[[nodiscard]] OrderedJson load_case_json(const std::string& model_text, const OrderedJson& drawing);

} // namespace steplap
