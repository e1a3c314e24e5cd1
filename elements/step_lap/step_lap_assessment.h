// Assessment of each step-lap joint after a run.
#pragma once

#include "mbd/model/model.h"
#include "mbd/trust/joint_assessment.h"

#include <vector>

namespace steplap {

struct StepLapJoint;

/// Returns the assessment of one joint. Figures are NaN if the run did not compute extremes.
[[nodiscard]] JointAssessment assess_joint(const StepLapJoint& joint, const Model& model, const RunResult& result);
/// Returns one assessment for every step_lap_joint of the model, in order.
[[nodiscard]] std::vector<JointAssessment> assess_joints(const Model& model, const RunResult& result);

} // namespace steplap
