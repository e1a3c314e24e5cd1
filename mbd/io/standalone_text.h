// Texts of models that name other files, written so that these are found from any folder.
#pragma once

#include "mbd/io/document.h"
#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns the document as one TOML text that can be used in any folder. Other files are named by absolute paths with the SHA-256 of their
/// present content, so that changed files are refused on reading (record_signal.cpp).
[[nodiscard]] std::string standalone_text(const Document& document, const Catalogue& catalogue);

/// Returns such a text with "path=value" overrides of keys in [simulation] and [output]; equal to standalone_text() of a document with
/// these overrides. Throws ModelError for other paths.
[[nodiscard]] std::string text_with_settings(const std::string& text, const std::vector<std::string>& assignments);

/// Returns the path that a file name in `node` means: relative to the file that contains the node; unchanged on the command line.
[[nodiscard]] std::string path_named_by(const Node& node, const std::string& name);

} // namespace steplap
