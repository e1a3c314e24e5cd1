// Summary of a run: verdict and reason, what happened, how near each limit was, and how reliable the numbers are. Used for the screen
// (tools/steplap/overview_screen.h), for summary.json and for pages.
#pragma once

#include "mbd/run/report.h"
#include "mbd/run/story.h"
#include "mbd/run/utilisation.h"

#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Reliability of the numbers of a run.
enum class TrustLevel {
  good,    ///< errors are estimated and small
  limited, ///< errors are unknown, or large in some channel
  none     ///< the run ended early, or its checks failed
};

/// Returns "good", "limited" or "none".
[[nodiscard]] const char* name_of(TrustLevel level);

/// Reliability with its reason and the checks made.
struct Trust {
  TrustLevel level = TrustLevel::limited; ///< reliability
  std::string text;                       ///< one sentence, or two short ones
  std::vector<std::string> guards = {};   ///< checks that were made: "energy balance", "finer run", name of a second method
};

/// Summary of a run that fits on one screen.
struct Overview {
  Verdict verdict = Verdict::open; ///< verdict of the judgement; open if there are no criteria
  bool is_judged = false;          ///< true if there is a verdict: criteria exist, or the run is unreliable
  std::string reason;              ///< reason of the verdict, one sentence
  Trust trust;                     ///< reliability of the numbers
  /// Time of the highest utilisation, s, among judged criteria; among all limits if there are no criteria.
  std::optional<double> worst_instant;
  std::vector<StoryEntry> story;         ///< events in order of time
  std::vector<Utilisation> utilisations; ///< sorted, highest first
  std::vector<std::string> moved;        ///< elements that slipped, opened or broke
};

/// Summarises a run. The cost is linear in the number of channels, events and samples.
[[nodiscard]] Overview overview_of(const Report& report, ShownDigits digits = {});

} // namespace steplap
