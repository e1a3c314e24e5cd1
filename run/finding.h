// Something found in a model or its run that is allowed, but hardly meant.
#pragma once

#include "mbd/base/diagnostics.h"

#include <string>

namespace steplap {

/// How much a finding weighs.
enum class FindingLevel {
  warning, ///< hardly meant
  note     ///< may well be meant, and is worth knowing
};

/// One thing found, with what programs, people and editors need to show it.
struct Finding {
  std::string code;                           ///< for programs: "starts_deep"; what it stands for does not change
  FindingLevel level = FindingLevel::warning; ///< how much it weighs
  std::string text;                           ///< one or two sentences, without the place
  Location where;                             ///< in the model's file; line 0 if it is of no one place
};

/// "text (file:line)"
[[nodiscard]] std::string text_with_place(const Finding& finding);
/// Does the finding forbid to call a run "hold"? What is unusual is no reason to open a machine, and none to sign for it.
[[nodiscard]] bool caps_verdict(const Finding& finding);

} // namespace steplap
