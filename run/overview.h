// What a reader wants to know first of a run: the verdict and why, what happened, how near everything came to its limit, and how far
// the numbers can be trusted. Made once, for the screen (tools/steplap/overview_screen.h), for summary.json and for pages.
#pragma once

#include "run/report.h"
#include "run/story.h"
#include "run/utilisation.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// How far the numbers of a run can be trusted.
enum class TrustLevel {
  good,    ///< errors are estimated, and are small
  limited, ///< errors are not known, or large somewhere
  none     ///< the run broke off, or contradicts itself
};

/// "good", "limited" or "none".
[[nodiscard]] const char* name_of(TrustLevel level);

/// How far, a sentence that says why, and what has looked at the run.
struct Trust {
  TrustLevel level = TrustLevel::limited; ///< how far
  std::string text;                       ///< one sentence, or two short ones
  std::vector<std::string> guards = {};   ///< checks that were made: "energy balance", "finer run", the name of a second method
};

/// The run on one screen.
struct Overview {
  Verdict verdict = Verdict::open;       ///< that of the judgement; open where nothing was asked
  bool is_judged = false;                ///< something was asked of the run, or it is not to be trusted: there is a verdict
  std::string reason;                    ///< why, in one sentence
  Trust trust;                           ///< how far the numbers can be trusted
  std::optional<double> worst_instant;   ///< s: when the worst of what is judged was reached, or of all, if nothing is
  std::vector<StoryEntry> story;         ///< what happened, in order of time
  std::vector<Utilisation> utilisations; ///< the worst first
  std::vector<std::string> moved;        ///< elements that slipped, opened or broke
};

/// Of any run; its cost grows with the number of channels, events and samples, and no faster.
[[nodiscard]] Overview overview_of(const Report& report, ShownDigits digits = {});

} // namespace steplap
