// What a run came to: extremes, events and accuracy, the same for the screen, for summary.json and
// for whoever reads a run in code.
#pragma once

#include "mbd/analysis/global_error.h"
#include "tools/steplap/findings.h"
#include "tools/steplap/run.h"
#include "tools/steplap/second_opinion.h"
#include "transformer/verdict_error.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace steplap {

/// Pointers lead into the run's compiled system: valid as long as the run.
struct RunSummary {
  std::vector<ChannelRange> ranges;          ///< of all channels of the system, written or not (mbd/simulation/extremes.h)
  std::map<std::string, long> event_counts;  ///< by the words of the kind
  double relative_energy_residual = 0.0;     ///< of the energy exchanged
  std::optional<GlobalErrorEstimate> global_error; ///< unless there is none
  std::string no_estimate;                   ///< why: "left out with --no-estimate"
  std::optional<double> estimate_cost;       ///< s, of computing, for which it was left out
  Judgement judgement;
  std::vector<Finding> findings;             ///< before the run: those that forbid "hold" stand in the judgement, too
  std::optional<SecondOpinion> second_opinion; ///< if one was asked for

  /// nullptr if there is no such channel.
  [[nodiscard]] const ChannelRange* find(const std::string& channel) const;
  /// Of the range, or empty without an estimate.
  [[nodiscard]] std::optional<double> error_of(const ChannelRange& range, double ChannelError::*which) const;
  /// Of the i-th event of the run.
  [[nodiscard]] std::optional<double> event_error(std::size_t i) const;
  [[nodiscard]] std::optional<double> dissipated_error() const;
  [[nodiscard]] std::optional<double> work_error() const;
};

[[nodiscard]] RunSummary summarise(const Run& run);

/// What an element has to bear, told by its unit: a force, a couple, the pressure that a joint would
/// need. What it could bear is none.
[[nodiscard]] bool is_reaction(const Channel& channel);
/// A path slid in friction.
[[nodiscard]] bool is_slide(const Channel& channel);
/// Of a kind that a reader looks for first (event_kind.h).
[[nodiscard]] bool is_main_event(const Event& event);

} // namespace steplap
