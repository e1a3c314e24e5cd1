// Completion of a model: adds what follows from other entries. These are poses of bodies that joints determine, markers for references to
// bodies, and the elements and bodies that tables such as [[core]] define.
//
// To change values, change the model as given and complete it again: a completed model does not follow changes of its inputs.
#pragma once

#include "mbd/model/placement.h"

namespace steplap {

/// Source locations of the fields of a model that is being completed, and which fields were given.
struct ModelPlaces {
  FieldLocator locate;  ///< location of a field; empty: messages refer to the location of the whole object
  GivenBodyField given; ///< whether a field of a body was given; empty: decided by Body::given, or by a difference from the default value
  /// Location of a field of entry `table` of Model::tables; nullopt if an error of this field has already been reported.
  std::function<std::optional<Location>(std::size_t table, const std::string& field)> locate_in_table;
  std::function<bool(std::size_t table)> is_table_usable; ///< returns false if the table could not be read; empty: all tables are usable
};

/// Completes the model in place, without validating it, and appends errors to `problems`. Returns true if all tables could be applied.
/// Throws std::logic_error for a model that is completed already.
bool complete(Model& model, const ModelPlaces& places, std::vector<Diagnostic>& problems);

/// Returns a completed and validated copy of `given`. Throws ModelError with all errors found.
[[nodiscard]] Model completed(const Model& given);

} // namespace steplap
