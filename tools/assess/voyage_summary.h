// Results of a voyage to which criteria are applied, for the detailed simulation and for each sample.
#pragma once

#include "mbd/trust/judgement.h"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace steplap::assess {

/// Worst outcome of the limits in all models: [[acceptance]] tables and limits of elements.
struct LimitsSummary {
  Verdict outcome = Verdict::hold;
  double share = 0.0; ///< utilisation of the limit; 0: unknown
  std::string unmet;  ///< the exceeded limit as a text, "'bottom arresting devices' in event 1, 106 % of its limit"

  /// Keeps the worse of the present and the given outcome; for equal outcomes, the one with the larger utilisation.
  void note(Verdict outcome_, double share_, const std::string& unmet_) {
    const bool is_worse = outcome_ > outcome || (outcome_ == outcome && outcome != Verdict::hold && share_ > share);
    if (is_worse) outcome = outcome_, share = share_, unmet = unmet_;
  }
};

/// Worst values over all models and events so far.
struct VoyageSummary {
  double least_margin = std::numeric_limits<double>::infinity(); ///< smallest ratio of a joint's friction capacity to its demand
  double slid = 0.0;                                             ///< largest slide of a joint, summed over events, m
  double overlap_left = 1.0;                                     ///< smallest remaining overlap of a joint, as a fraction
  bool slips = false, lifts = false, comes_apart = false;
  bool moves = false;                 ///< true if any friction slid, any contact opened, or anything broke
  LimitsSummary limits, known_limits; ///< `known_limits` excludes limits that are assumed (assumed_limits.h)
  double planes_use = 0.0;            ///< largest combined utilisation of a friction shared by two planes
  /// verdict on the slide of shared frictions: inspect if it exceeds a limit or is only an upper bound, open if there is no limit
  Verdict planes = Verdict::hold;
  std::string planes_slip; ///< sentence about the largest such slide; "" if there is none
  std::string unknown;     ///< reason why a run failed or is not trusted; "" if there is none
  std::string first_slip;  ///< the first slip as a text, "'front joint' slips in event 3"

  /// Takes the outcome of a limit into account.
  void note_limit(Verdict outcome, bool is_assumed, double share, const std::string& unmet) {
    limits.note(outcome, share, unmet);
    if (!is_assumed) known_limits.note(outcome, share, unmet);
  }
};

/// Merges `other` into `summary`, keeping the worse of each value.
inline void worsen(VoyageSummary& summary, const VoyageSummary& other) {
  summary.least_margin = other.least_margin < summary.least_margin ? other.least_margin : summary.least_margin;
  summary.slid = other.slid > summary.slid ? other.slid : summary.slid;
  summary.overlap_left = other.overlap_left < summary.overlap_left ? other.overlap_left : summary.overlap_left;
  summary.slips |= other.slips;
  summary.lifts |= other.lifts;
  summary.comes_apart |= other.comes_apart;
  summary.moves |= other.moves;
  summary.limits.note(other.limits.outcome, other.limits.share, other.limits.unmet);
  summary.known_limits.note(other.known_limits.outcome, other.known_limits.share, other.known_limits.unmet);
  if (other.planes_use > summary.planes_use) summary.planes_use = other.planes_use;
  if (!other.planes_slip.empty() && (summary.planes_slip.empty() || other.planes >= summary.planes))
    summary.planes = other.planes, summary.planes_slip = other.planes_slip;
  if (summary.unknown.empty()) summary.unknown = other.unknown;
  if (summary.first_slip.empty()) summary.first_slip = other.first_slip;
}

} // namespace steplap::assess
