// Lists the effects on a core that a planar model of rigid bodies cannot contain. Every verdict on a core shows them.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns one sentence for each effect. Returns none if the model has no step-lap joint.
[[nodiscard]] std::vector<std::string> left_out_of_cores(const Model& model);

} // namespace steplap
