// Writes a tree of nodes as TOML text that reads back as the same tree.
#pragma once

#include "mbd/io/toml_text.h"

namespace steplap {

/// Returns the text: top-level values first, then tables, then arrays of tables, each in the order of the tree.
[[nodiscard]] std::string write_toml(const Node& root);

} // namespace steplap
