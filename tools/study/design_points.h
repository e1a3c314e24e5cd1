// Design points: the places of the limit state's surface that are nearest to the origin of standard normal space, and
// what first and second order theory (FORM, SORM) make of them. Searched for from several starts; second order by
// OpenTURNS.
#pragma once

#include "tools/study/limit_function.h"

namespace steplap::study {

struct DesignPoint {
  std::vector<double> u;
  double beta = 0.0;         ///< signed: negative if the origin fails
  double g = 0.0;            ///< there; zero if the search has arrived
  double off_surface = 0.0;  ///< |g| / |∇g|: how far from the surface that is, in standard deviations
  double misalignment = 0.0; ///< 1 − cosine between u and the gradient's line: zero where it is nearest
  std::vector<double> alpha; ///< −u/beta: squares are the importance factors
  double breitung = 0.0, hohenbichler = 0.0,
         tvedt = 0.0;    ///< probabilities of second order; not-a-number if not asked or unfit
  bool is_found = false; ///< on the surface, and nearest there
};

struct DesignPoints {
  std::vector<DesignPoint> points; ///< found ones, the nearest first
  long starts = 0, failed_starts = 0;
  long left_starts = 0; ///< not searched from: the samples for searches were used up
  bool is_origin_failing = false;
  std::string trouble; ///< of the starts that failed, the first
  long samples = 0;
};

[[nodiscard]] DesignPoints find_design_points(LimitFunction& limit, bool is_second_order);

/// Searches once more, from `start`. True if it came to a point that is not among `found`, which is put there.
bool search_again(LimitFunction& limit, const std::vector<double>& start, DesignPoints& found);

} // namespace steplap::study
