// Models that name other files: where those are, and a text of the model that finds them from any folder.
#pragma once

#include "mbd/io/document.h"
#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// The document as TOML that stands alone and finds its files from any folder: they are named by their absolute paths, with the
/// SHA-256 of what they hold now, so that another content is refused when it is read (record_signal.cpp).
[[nodiscard]] std::string standalone_text(const Document& document, const Catalogue& catalogue);

/// Such a text with "path=value" laid over keys of [simulation] and [output]: what standalone_text() gives of a document with these
/// overrides. Throws ModelError for a path that leads elsewhere.
[[nodiscard]] std::string text_with_settings(const std::string& text, const std::vector<std::string>& assignments);

/// What the name of a file in `node` means: relative to the file in which the node stands; as it is on the command line.
[[nodiscard]] std::string path_named_by(const Node& node, const std::string& name);

} // namespace steplap
