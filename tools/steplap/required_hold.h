// Exit code of `--require-hold`, which demands the verdict "hold" of all runs.
#pragma once

#include "mbd/trust/judgement.h"
#include "tools/steplap/command.h"

#include <algorithm>
#include <vector>

namespace steplap {

/// Returns `done` if all verdicts are "hold". Otherwise returns numerical_failure if a run is not trusted, else criterion_failed.
[[nodiscard]] inline ExitCode required_hold(const std::vector<const Judgement*>& judgements) {
  const auto is_held = [](const Judgement* one) { return one->verdict == Verdict::hold; };
  const auto is_trusted = [](const Judgement* one) { return one->distrust.empty(); };
  if (std::all_of(judgements.begin(), judgements.end(), is_held)) return ExitCode::done;
  return std::all_of(judgements.begin(), judgements.end(), is_trusted) ? ExitCode::criterion_failed : ExitCode::numerical_failure;
}

} // namespace steplap
