// What is found in a model that is allowed, but hardly meant: for the screen, for results, for whoever shows it beside a verdict.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>
#include <vector>

namespace steplap {

struct LoadedModel;

enum class FindingLevel {
  warning, ///< hardly meant
  note     ///< may well be meant, and is worth knowing
};

struct Finding {
  std::string code; ///< for programs: "starts_deep"; what it stands for does not change
  FindingLevel level = FindingLevel::warning;
  std::string text; ///< one or two sentences, without the place
  Location where;   ///< in the model's file; line 0 if it is of no one place
};

/// All that `steplap check` finds, in its order. Runs nothing but the start.
[[nodiscard]] std::vector<Finding> findings_of(const LoadedModel& loaded);
/// Those about where the run begins: contacts and stops that contradict the poses, inertias that contradict outlines.
[[nodiscard]] std::vector<Finding> start_findings(const LoadedModel& loaded);

/// Those about values unlike any: cores, loads that do nothing, sizes apart (plausible_scene.h).
[[nodiscard]] std::vector<Finding> implausible_findings(const LoadedModel& loaded);

/// "text (file:line)"
[[nodiscard]] std::string text_with_place(const Finding& finding);

} // namespace steplap
