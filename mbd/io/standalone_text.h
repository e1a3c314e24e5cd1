// Writes models that use other files as texts that are valid in any folder.
#pragma once

#include "mbd/io/document.h"
#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns the document as one TOML text that can be read in any folder. Other files are named by absolute paths with the SHA-256 of their
/// present content. If such a file has changed when the text is read, an error is reported (record_signal.cpp).
[[nodiscard]] std::string standalone_text(const Document& document, const Catalogue& catalogue);

/// Returns a text by standalone_text() with "path=value" overrides of keys in [simulation] and [output]. The result equals
/// standalone_text() of a document with these overrides. Throws ModelError for other paths.
[[nodiscard]] std::string text_with_settings(const std::string& text, const std::vector<std::string>& assignments);

/// Returns the path of a file that `node` names: relative to the folder of the file that contains the node; unchanged on the command line.
[[nodiscard]] std::string path_named_by(const Node& node, const std::string& name);

} // namespace steplap
