// What every step-lap joint is held to, whatever its model asks.
//
// A joint that slipped, or would have where it is only monitored, or that has less margin than the model asks for, means
// inspect: the core's magnetic circuit is not as it was built. One that came apart, lost a whole corner or slid further than it
// bears means reject; one whose edges were crushed, too.
#pragma once

#include "mbd/trust/element_judgement.h"

namespace steplap {

/// ElementKind::judge of step_lap_joint.
[[nodiscard]] ElementJudgement judge_step_lap_joint(const Element& element, const Model& model, const RunResult& result);
/// ElementKind::channels_of_trust of step_lap_joint.
[[nodiscard]] std::vector<std::string> trust_of_step_lap_joint(const Element& element);

} // namespace steplap
