// Which uncertain number the decision hangs on.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Fills `hangs_on` of an assessment that has been decided: sentences for people.
void find_what_it_hangs_on(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
