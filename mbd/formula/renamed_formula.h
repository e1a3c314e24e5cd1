// Formulas with other names for their operands: what a formula becomes where its file is a part of another, or an index a number.
#pragma once

#include <functional>
#include <string>

namespace steplap {

/// The text of the formula with what `renamed` gives in place of each operand; nothing else in it changes. A name that is not made
/// of letters, digits, _ and points has to come back in braces. Text that is no formula stays as it is: whoever reads it says why.
[[nodiscard]] std::string with_operands(const std::string& text, const std::function<std::string(const std::string& name)>& renamed);

} // namespace steplap
