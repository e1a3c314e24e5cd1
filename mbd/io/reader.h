// Model files (TOML) read into a Model, with the element, signal and table kinds of a catalogue.
//
// [[marker]] and inline markers without 'point' and 'at' sit at the body's centre of gravity. Where
// an element wants a marker, a body's name means a marker of that name at its centre of gravity,
// which the reader adds ("ground": the origin); an inline table { body, point | at, angle } becomes
// a marker called "element.field". So after reading every marker field names an entry of
// Model::markers, and every marker has 'point' or 'at'.
//
// All errors of a file are collected: syntax, units, unknown keys, then everything that validate()
// finds, in the order of the lines.
#pragma once

#include "mbd/io/overrides.h"
#include "mbd/model/model.h"

namespace steplap {

/// Reads the file, with "path=value" overrides (overrides.h). Throws ModelError. `text`, if not null, becomes what
/// standalone_text() gives, of the same reading of the file.
[[nodiscard]] Model read_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {},
                               std::string* text = nullptr);

/// The file with all that it extends and the overrides laid over it, as TOML that stands alone. Paths
/// of other files in it stay relative to where they were. Throws ModelError.
[[nodiscard]] std::string effective_model_text(const std::string& path, const Catalogue& catalogue,
                                               const std::vector<std::string>& overrides = {});

/// The same for text at hand; `file_name` is what messages call it and what paths are relative to.
[[nodiscard]] Model parse_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                const std::vector<std::string>& overrides = {});

/// Models as given, for whoever sets values in them (mbd/model/model_path.h) and completes them (mbd/model/completion.h). They are
/// read, completed and checked as above, so that what is wrong is said with its place. Throw ModelError.
[[nodiscard]] Model read_given_model(const std::string& path, const Catalogue& catalogue, const std::vector<std::string>& overrides = {});
/// The same for text at hand, as parse_model() takes it.
[[nodiscard]] Model parse_given_model(std::string text, const std::string& file_name, const Catalogue& catalogue,
                                      const std::vector<std::string>& overrides = {});

} // namespace steplap
