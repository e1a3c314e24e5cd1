// Reads model files (TOML) into a Model, with the element, signal and table kinds of a catalogue.
//
// [[marker]] and inline markers without 'point' and 'at' are at the body's centre of gravity. If an element needs a marker, the name of a
// body stands for a marker at its centre of gravity, which the reader adds ("ground": the origin). An inline table { body, point | at,
// angle } becomes a marker with the name "element.field". So after reading, every marker field names an entry of Model::markers, and every
// marker has 'point' or 'at'.
//
// All errors of a file are collected: syntax, units, unknown keys, then all problems found by validate(), in the order of lines.
// finds, in the order of the lines.
#pragma once

#include "mbd/io/overrides.h"
#include "mbd/model/model.h"

namespace steplap {

/// Reads a file with "path=value" overrides (overrides.h). `text`, if not null, receives standalone_text() of the same reading. Throws
/// ModelError.
[[nodiscard]] Model read_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {},
                               std::string* text = nullptr);

/// Returns the file, with all that it extends and the overrides, as one TOML text. Paths of other files in it stay relative to their
/// original folder. Throws ModelError.
[[nodiscard]] std::string effective_model_text(const std::string& path, const Catalogue& catalogue,
                                               const std::vector<std::string>& overrides = {});

/// Reads a text. `file_name` is used in messages and as the base of relative paths.
[[nodiscard]] Model parse_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                const std::vector<std::string>& overrides = {});

/// Return models as given, without completion, for callers that set values (mbd/model/model_path.h) and complete them later
/// (mbd/model/completion.h). They are read, completed and checked as above, so that errors are reported with their location. Throw
/// ModelError.
[[nodiscard]] Model read_given_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {});
/// Reads a given model from a text, like parse_model().
[[nodiscard]] Model parse_given_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                      const std::vector<std::string>& overrides = {});

} // namespace steplap
