// Fields of elements that contain formulas (mbd/formula/formula.h): text fields called "formula", "rate" or "when".
//
// Names in formulas refer to channels, states, signals and parameters. If a file is used as a part of another, these names get the prefix
// of the part. Channels used in formulas are computed even if they are not written.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Returns true if a text field with this name is a formula.
[[nodiscard]] bool is_formula_key(const std::string& name);
/// Returns true if the field is a text that is parsed as a formula.
[[nodiscard]] bool is_formula_field(const Field& field);

/// Returns true for names that refer to the element's own coordinate and therefore get no prefix.
[[nodiscard]] bool is_own_name(const std::string& name);

/// Returns the names used in the formulas of an element, each once. Texts that are not valid formulas are skipped.
[[nodiscard]] std::vector<std::string> names_in_formulas(const ElementEntry& entry);

} // namespace steplap
