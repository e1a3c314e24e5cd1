// Model table [[uncertain]]: a number of the model that is not known exactly, with its distribution and its source. Ordinary runs use the
// value of the model; an assessment draws the number from its distribution, once for each voyage.
#pragma once

#include "mbd/model/model.h"

namespace steplap {

/// One uncertain number as given in the model file. Numbers are texts, because their unit is that of the field to which a path refers.
struct Uncertain : TableObject {
  std::vector<std::string> paths;       ///< paths of the fields that get the value
  bool is_factor = false;               ///< true: the drawn value multiplies the value in the model
  std::string distribution;             ///< name of the distribution, as in a study's variable
  std::string mean, standard_deviation; ///< texts in the unit of the paths
  std::optional<double> cov;            ///< coefficient of variation, standard deviation/mean
  std::string low, high, mode;          ///< parameters of a uniform or triangular distribution
  std::string lower, upper;             ///< truncation limits of the distribution
  std::string source;                   ///< "measured", "specified" or "assumed"
  std::string source_text;              ///< details of the source: author, date, document
};

/// Returns the kind of table. The table is checked and adds nothing to the model.
[[nodiscard]] const TableKind& uncertain_kind();

/// Returns all uncertain numbers of the model, in order.
[[nodiscard]] std::vector<const Uncertain*> uncertain_of(const Model& model);

/// Returns the SI value of a text of the table; empty if it is not given. Throws ModelError with the location of the field. `model` may be
/// as given or completed.
[[nodiscard]] std::optional<double> value_of_text(const Uncertain& uncertain, const std::string& field, const std::string& text,
                                                  const Model& model);

} // namespace steplap
