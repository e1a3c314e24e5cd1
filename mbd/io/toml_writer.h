// A tree of nodes written as TOML text that reads back as the same tree.
#pragma once

#include "mbd/io/toml_text.h"

namespace steplap {

/// Top-level values first, then tables, then arrays of tables, each in the order of the tree.
[[nodiscard]] std::string write_toml(const Node& root);

} // namespace steplap
