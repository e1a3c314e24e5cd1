// The kind "needs": what a scene needs. Every element in turn is taken out, or holds rigidly what it connects; every
// body in turn is fixed. What changes in the responses by how much?
#pragma once

#include "study/study_run.h"

namespace steplap::study {

/// All variants of a model, as given; their names are what findings are about.
[[nodiscard]] std::vector<ModelVariant> variants_of(const Model& model);

void check_needs(const LoadedStudy& loaded, std::vector<Diagnostic>& problems);
[[nodiscard]] Answer run_needs(StudyRun& run);

} // namespace steplap::study
