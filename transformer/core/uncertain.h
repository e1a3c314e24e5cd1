// [[uncertain]]: a number of the model that is not known exactly: its distribution, and where that comes from.
//
// Usual runs take the model's own value. An assessment draws the number from its distribution, once for a voyage.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// An uncertain number as a model file describes it. Numbers are texts, as their unit is that of the path.
struct Uncertain : TableObject {
  std::vector<std::string> paths;       ///< fields that get the value, or one text
  bool is_factor = false;               ///< the value multiplies what the model has there
  std::string distribution;             ///< as of a study's variable
  std::string mean, standard_deviation; ///< in the unit of the paths
  std::optional<double> cov;            ///< standard deviation over mean
  std::string low, high, mode;          ///< of a uniform or triangular distribution
  std::string lower, upper;             ///< the distribution is truncated there
  std::string source;                   ///< "measured", "specified" or "assumed"
  std::string source_text;              ///< by whom, when, from which document
};

/// The table's kind: it checks itself and adds nothing to the model.
[[nodiscard]] const TableKind& uncertain_kind();

/// Of the model, in its order.
[[nodiscard]] std::vector<const Uncertain*> uncertain_of(const Model& model);

/// What a text of the table is worth in SI; empty if it is not given. Throws ModelError at the field. `model`: as given or completed.
[[nodiscard]] std::optional<double> value_of_text(const Uncertain& uncertain, const std::string& field, const std::string& text,
                                                  const Model& model);

} // namespace steplap
