// Load cases of a model: table [[case]]. Each case is a run of the same model with other values. mbd/run/load_cases.h runs all cases.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// Table [[case]]: the values of one load, its source, and the criteria that apply.
struct LoadCase : TableObject {
  std::vector<std::string> changes;  ///< field `set`: "path=value" as in overrides.h
  std::optional<Vec2> pull;          ///< m/s², added to gravity: minus the constant acceleration of the vehicle
  std::string plane;                 ///< "lengthwise", "transverse" or "" (not stated): section that the model shows
  std::string source;                ///< document that requires the load, with its edition
  std::vector<std::string> criteria; ///< patterns of the names of [[acceptance]] that apply; empty: all

  /// Returns the changes of this case as "path=value"; `gravity` is that of the model, m/s², to which `pull` is added.
  [[nodiscard]] std::vector<std::string> overrides(const Vec2& gravity) const;
};

[[nodiscard]] const TableKind& case_kind();
/// Returns the cases of a model, in the order of the file.
[[nodiscard]] std::vector<LoadCase> load_cases_of(const Model& model);

} // namespace steplap
