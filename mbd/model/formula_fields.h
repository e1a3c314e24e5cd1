// Which fields of elements hold formulas (mbd/formula/formula.h): texts called "formula", "rate" or "when".
//
// Names in them are those of channels, states, signals and parameters. Where a file is a part of another they get its prefix,
// and channels that they name are made although nobody writes them.
#pragma once

#include "mbd/model/model.h"

#include <string>
#include <vector>

namespace steplap {

/// Is a field of that name one, if it is a text?
[[nodiscard]] bool is_formula_key(const std::string& name);
/// A text that is read as a formula.
[[nodiscard]] bool is_formula_field(const Field& field);

/// Names that stand for the element's own coordinate, whatever part it is of.
[[nodiscard]] bool is_own_name(const std::string& name);

/// Names in the formulas of an element, each once; none of what is no formula.
[[nodiscard]] std::vector<std::string> names_in_formulas(const ElementEntry& entry);

} // namespace steplap
