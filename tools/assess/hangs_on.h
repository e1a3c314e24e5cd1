// Finds the uncertain number on which the decision depends most.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Fills `hangs_on` of an assessment after its decision, with sentences for the user.
void find_what_it_hangs_on(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
