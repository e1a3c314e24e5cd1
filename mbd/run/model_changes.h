// Lists the differences between two models as given in their files. Values are identified by the paths that `--set` uses.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A value that differs, or an entry that exists in one model only.
struct ModelChange {
  enum class Kind { value, added, removed }; ///< a different value; an entry of the second model only; an entry of the first model only

  Kind kind = Kind::value;             ///< kind of change
  std::string path;                    ///< "element.front foot.stiffness"; for an entry "element.front foot"
  std::string unit;                    ///< SI unit of the numbers
  std::optional<double> before, after; ///< numbers; empty if the value is not a number or not given
  std::string before_text, after_text; ///< values as text; "" if not given
  bool follows = false;                ///< both models compute the value from the same formula of parameters
};

/// Returns the changes from `a` to `b`, both as given (mbd/io/reader.h): parameters first, then in the order of the files. A default that
/// is written out in one file is not a change.
[[nodiscard]] std::vector<ModelChange> changes_between(const Model& a, const Model& b);

} // namespace steplap
