// Finds the limits of a model that its author assumed. A decision to return the machine needs a limit that is specified or measured.
#pragma once

#include "mbd/model/model.h"
#include "mbd/trust/judgement.h"

#include <string>
#include <vector>

namespace steplap::assess {

/// Returns the names of the [[acceptance]] tables of a model, as given, whose limit is assumed: by their `source`, or by that of an
/// [[uncertain]] parameter on which the limit depends.
[[nodiscard]] std::vector<std::string> assumed_limits(const Model& given);

/// Returns true if criterion `index` of a judgement of `model` is an [[acceptance]] with one of the names in `assumed`.
[[nodiscard]] bool is_assumed(const std::vector<std::string>& assumed, const Model& model, const Judgement& judgement, std::size_t index);

} // namespace steplap::assess
