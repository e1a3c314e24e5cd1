// What a model leaves to be found from its other entries, put in: bodies' places by joints, markers that stand for
// bodies, whatever tables of other folders stand for.
//
// A model as given, by a file or by code, may say where a body is by the angle of a joint, call a body where a marker is
// wanted, or describe a core by its dimensions. Whoever wants other values sets them in the model as given and completes
// it again: a completed model does not follow.
#pragma once

#include "mbd/model/placement.h"

namespace steplap {

/// Where the fields of a model that is being completed stand in its file, and which of them were given.
struct ModelPlaces {
  FieldLocator locate;  ///< empty: every message points at the object's own place
  GivenBodyField given; ///< empty: a field is given that Body::given says, or that differs from its default
  /// Of the index-th entry of Model::tables; nullopt: its error is reported already.
  std::function<std::optional<Location>(std::size_t table, const std::string& field)> locate_in_table;
  std::function<bool(std::size_t table)> is_table_usable; ///< false: it could not be read; empty: all are
};

/// Completes the model in place. Problems are appended; true if all tables could be applied. The model is not
/// validated. Not to be called twice on one model.
bool complete(Model& model, const ModelPlaces& places, std::vector<Diagnostic>& problems);

/// A copy of `given`, completed and validated. Throws ModelError with all that is wrong.
[[nodiscard]] Model completed(const Model& given);

} // namespace steplap
