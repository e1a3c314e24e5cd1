// What a voyage came to, as criteria look at it: the same of the voyage in detail and of every sample of it.
#pragma once

#include "mbd/trust/judgement.h"

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace steplap::assess {

/// Of all models and events so far, the worst.
struct VoyageSummary {
  double least_margin = std::numeric_limits<double>::infinity(); ///< of a joint's friction capacity over its demand
  double slid = 0.0;                                             ///< m, of the joint that slid most, sum over events
  double overlap_left = 1.0;                                     ///< share, of the joint that has least
  bool slips = false, lifts = false, comes_apart = false;
  Verdict acceptance = Verdict::hold; ///< of what the models ask: [[acceptance]] and elements' own
  double planes_use = 0.0;            ///< largest share of a friction that two planes use together
  Verdict planes = Verdict::hold;     ///< of what they slide: inspect beyond a limit or as an upper bound, open without a limit
  std::string planes_slip;            ///< a sentence on the worst of it; "" where they slide nothing together
  std::string unknown;                ///< not empty: why a run of it could not be made or is not to be trusted
  std::string first_slip;             ///< "'front joint' slips in event 3", for people
  std::string first_unmet;            ///< "'bottom arresting devices' in event 1", of the worst acceptance
};

/// The worse of both.
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
