// Finds the uncertain numbers on which the decision depends.
#pragma once

#include "tools/assess/assessment.h"

namespace steplap::assess {

/// Fills `hangs_on` of a decided assessment with sentences for the user.
void find_dependence(const AssessmentOptions& options, Assessment& assessment);

} // namespace steplap::assess
