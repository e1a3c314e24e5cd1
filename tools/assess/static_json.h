// static.json: what a static proof found, for the page and for programs. SI units, angles of directions in degrees.
#pragma once

#include "tools/assess/static_proof.h"

#include <string>

namespace steplap::assess {

/// The text of static.json for several models, each with the SHA-256 of its file.
[[nodiscard]] std::string static_json(const std::vector<StaticProof>& proofs, const std::vector<std::string>& sha256);

} // namespace steplap::assess
