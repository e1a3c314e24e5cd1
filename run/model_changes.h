// What differs between two models as their files give them: the values, by the paths that `--set` takes.
#pragma once

#include "mbd/model/model.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// A value that is another one, or an entry that only one of the models has.
struct ModelChange {
  enum class Kind { value, added, removed }; ///< another value; an entry that only the second, or only the first, model has

  Kind kind = Kind::value;             ///< what sort of change it is
  std::string path;                    ///< "element.front foot.stiffness"; of an entry "element.front foot"
  std::string unit;                    ///< SI, of the numbers
  std::optional<double> before, after; ///< numbers; nothing where the value is no number, or not given
  std::string before_text, after_text; ///< the values as text; "" where not given
  bool follows = false;                ///< a formula of parameters gives it in both models, the same one
};

/// From `a` to `b`, both as given (mbd/io/reader.h): parameters first, then in the order of the files. Defaults count as values, so that a default
/// written out is no change.
[[nodiscard]] std::vector<ModelChange> changes_between(const Model& a, const Model& b);

} // namespace steplap
