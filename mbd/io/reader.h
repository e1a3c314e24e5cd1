// Reads model files (TOML) into a Model, with the element, signal and table kinds of a catalogue.
//
// [[marker]] and inline markers without 'point' and 'at' are at the body's centre of gravity. Where an element needs a marker, the name of
// a body means a marker at its centre of gravity, which the reader adds ("ground": the origin). An inline table { body, point | at, angle }
// becomes a marker with the name "element.field". After reading, every marker field therefore names an entry of Model::markers, and every
// marker has 'point' or 'at'.
//
// All errors of a file are collected: syntax, units, unknown keys, then those found by validate(). They are reported in the order of lines.
#pragma once

#include "mbd/io/overrides.h"
#include "mbd/model/model.h"

namespace steplap {

/// Reads a file with "path=value" overrides (overrides.h) and returns the completed model. If `text` is not null, it receives
/// standalone_text() of the file. Throws ModelError with all errors.
[[nodiscard]] Model read_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {},
                               std::string* text = nullptr);

/// Returns the file, with all that it extends and with the overrides, as one TOML text. Paths of other files in the text stay relative to
/// the folder of the file that contained them. Throws ModelError.
[[nodiscard]] std::string effective_model_text(const std::string& path, const Catalogue& catalogue,
                                               const std::vector<std::string>& overrides = {});

/// Reads a model from a text. `file_name` is used in messages and as the base of relative paths. Throws ModelError.
[[nodiscard]] Model parse_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                const std::vector<std::string>& overrides = {});

/// Reads a text like parse_model(), for programs that generate models. `standalone` receives standalone_text() of the document. Throws
/// ModelError.
[[nodiscard]] Model parse_model_text(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                     const std::vector<std::string>& overrides, std::string& standalone);

/// Reads a model and returns it as given, without completion, for callers that set values (mbd/model/model_path.h) and complete it later
/// (mbd/model/completion.h). The model is also completed and checked, so that errors are reported with their location. Throws ModelError.
[[nodiscard]] Model read_given_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {});
/// Reads a model from a text, and returns it as given. Throws ModelError.
[[nodiscard]] Model parse_given_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                      const std::vector<std::string>& overrides = {});

} // namespace steplap
