// Finds limits of a model that are marked as assumed. They alone cannot lead to the decision "return", which requires a specified or
// measured limit.
#pragma once

#include "mbd/model/model.h"
#include "mbd/trust/judgement.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Returns the names of the [[acceptance]] tables of a model whose limit is assumed according to their `source`, or to the `source` of an
/// [[uncertain]] parameter used in the limit. `given`: the model before completion.
[[nodiscard]] std::vector<std::string> assumed_limits(const Model& given);

/// Returns true if criterion `index` of a judgement of `model` is an [[acceptance]] with one of the names in `assumed`.
[[nodiscard]] bool is_assumed(const std::vector<std::string>& assumed, const Model& model, const Judgement& judgement, std::size_t index);

} // namespace steplap::assess
