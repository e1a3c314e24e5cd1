// Formulas with renamed operands, needed when a file is used as part of another, or when an index is replaced by a number.
#pragma once

#include <functional>
#include <string>

namespace steplap {

/// Returns the text of the formula with each operand replaced by `renamed(name)` and no other change. A new name with other characters than
/// letters, digits, _ and points must be returned in braces. Text that is not a formula is returned unchanged; its error is reported when
/// it is read.
[[nodiscard]] std::string with_operands(const std::string& text, const std::function<std::string(const std::string& name)>& renamed);

} // namespace steplap
