// A finding: something in a model or its run that is permitted but probably not intended.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>

namespace steplap {

/// Severity of a finding.
enum class FindingLevel {
  warning, ///< probably not intended
  note     ///< possibly intended, but worth knowing
};

/// A finding with everything needed to show it.
struct Finding {
  std::string code;                           ///< identifier for programs, such as "starts_deep"; meanings never change
  FindingLevel level = FindingLevel::warning; ///< severity
  std::string text;                           ///< one or two sentences, without the location
  Location where;                             ///< location in the model file; line 0 if it concerns no single place
};

/// Returns "text (file:line)".
[[nodiscard]] std::string text_with_place(const Finding& finding);
/// Returns true if the finding prevents the verdict "hold": the verdict is then at most "open".
[[nodiscard]] bool caps_verdict(const Finding& finding);

} // namespace steplap
