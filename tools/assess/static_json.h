// Writes the results of static proofs as static.json, which the page and scripts read. SI units; directions in degrees.
#pragma once

#include "tools/assess/static_proof.h"

#include <string>

namespace steplap::assess {

/// Returns the text of static.json for several models, each with the SHA-256 of its file.
[[nodiscard]] std::string static_json(const std::vector<StaticProof>& proofs, const std::vector<std::string>& sha256);

} // namespace steplap::assess
