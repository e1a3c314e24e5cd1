// What no planar model of rigid bodies can know of a core, told wherever one is judged.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Sentences for the reader of a verdict; none of a model, given or completed, without a step-lap joint.
[[nodiscard]] std::vector<std::string> left_out_of(const Model& model);

} // namespace steplap
