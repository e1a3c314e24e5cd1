// What kinds that draw samples at random ask of a study's variables.
#pragma once

#include "tools/study/study_reader.h"

namespace steplap::study {

/// That there is a variable that varies at random, and none of which only a list of values is known.
void check_random(const LoadedStudy& loaded, bool takes_ranges, std::vector<Diagnostic>& problems);

} // namespace steplap::study
