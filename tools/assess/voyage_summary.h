// Results of a voyage that criteria use, for the detailed simulation and for each sample.
#pragma once

#include "mbd/trust/judgement.h"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace steplap::assess {

/// Worst values over all models and events so far.
struct VoyageSummary {
  double least_margin = std::numeric_limits<double>::infinity(); ///< smallest friction capacity over demand of a joint
  double slid = 0.0;                                             ///< largest slide of a joint, summed over events, m
  double overlap_left = 1.0;                                     ///< smallest remaining overlap of a joint, as a fraction
  bool slips = false, lifts = false, comes_apart = false;
  Verdict acceptance = Verdict::hold; ///< verdict on the limits in the models: [[acceptance]] and those of elements
  double planes_use = 0.0;            ///< largest share of a friction used by two planes together
  Verdict planes = Verdict::hold;     ///< verdict on the slide of shared frictions: inspect beyond a limit or if the slide is an upper
                                      ///< bound, open if there is no limit
  std::string planes_slip;            ///< sentence about the largest such slide; "" if there is none
  std::string unknown;                ///< if not empty: reason why a run failed or cannot be trusted
  std::string first_slip;             ///< for people: "'front joint' slips in event 3"
  std::string first_unmet;            ///< "'bottom arresting devices' in event 1", of the worst acceptance
};

/// Merges `other` into `summary`, keeping the worse of each value.
inline void worsen(VoyageSummary& summary, const VoyageSummary& other) {
  summary.least_margin = other.least_margin < summary.least_margin ? other.least_margin : summary.least_margin;
  summary.slid = other.slid > summary.slid ? other.slid : summary.slid;
  summary.overlap_left = other.overlap_left < summary.overlap_left ? other.overlap_left : summary.overlap_left;
  summary.slips |= other.slips;
  summary.lifts |= other.lifts;
  summary.comes_apart |= other.comes_apart;
  if (other.acceptance > summary.acceptance) summary.acceptance = other.acceptance, summary.first_unmet = other.first_unmet;
  if (other.planes_use > summary.planes_use) summary.planes_use = other.planes_use;
  if (!other.planes_slip.empty() && (summary.planes_slip.empty() || other.planes >= summary.planes))
    summary.planes = other.planes, summary.planes_slip = other.planes_slip;
  if (summary.unknown.empty()) summary.unknown = other.unknown;
  if (summary.first_slip.empty()) summary.first_slip = other.first_slip;
}

} // namespace steplap::assess
