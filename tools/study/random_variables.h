// Checks of a study's variables for kinds that draw random samples.
#pragma once

#include "tools/study/study_reader.h"

namespace steplap::study {

/// Checks that at least one variable is random, that none has a list of values and, unless `takes_ranges`, that none has a range without a
/// distribution. Appends errors to `problems`.
void check_random(const LoadedStudy& loaded, bool takes_ranges, std::vector<Diagnostic>& problems);

} // namespace steplap::study
