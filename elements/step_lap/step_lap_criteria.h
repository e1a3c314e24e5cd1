// Criteria for every step-lap joint, in addition to those of the model.
//
// Result "inspect": the joint slipped, or would have slipped if only monitored, or has less margin than the model requires; the core is
// then no longer as built. Result "reject": it came apart, lost a whole corner, slid farther than allowed, or its edges were crushed.
#pragma once

#include "mbd/trust/element_judgement.h"

namespace steplap {

/// Implements ElementKind::judge for step_lap_joint.
[[nodiscard]] ElementJudgement judge_step_lap_joint(const Element& element, const Model& model, const RunResult& result);
/// Implements ElementKind::channels_of_trust for step_lap_joint.
[[nodiscard]] std::vector<std::string> trust_of_step_lap_joint(const Element& element);

} // namespace steplap
