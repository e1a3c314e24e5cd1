// Finds design points: points of the limit state surface with locally minimum distance to the origin of standard normal space, searched
// from several starts. Computes probabilities by first and second order theory (FORM, SORM); second order uses OpenTURNS.
#pragma once

#include "tools/study/limit_function.h"

namespace steplap::study {

/// A design point in standard normal space.
struct DesignPoint {
  std::vector<double> u;
  double beta = 0.0;         ///< reliability index, signed: negative if the origin fails
  double g = 0.0;            ///< value of the limit function at u; zero if the search converged
  double off_surface = 0.0;  ///< |g| / |∇g|: distance to the surface in standard deviations
  double misalignment = 0.0; ///< 1 − cosine of the angle between u and the gradient; zero at a point of minimum distance
  std::vector<double> alpha; ///< −u/beta: squares are the importance factors
  double breitung = 0.0;     ///< second-order probability by Breitung's formula; NaN if not requested or not applicable
  bool is_found = false;     ///< true if u is on the surface and a point of minimum distance
};

/// Results of the search for design points.
struct DesignPoints {
  std::vector<DesignPoint> points; ///< converged points, nearest first
  long starts = 0, failed_starts = 0;
  long left_starts = 0; ///< starts that were not used because the sample budget was exhausted
  long needed = 0;      ///< points that sampling needs, as the others do not cover them
  long fruitless = 0;   ///< searches from places away from all points, since the last one that found such a point
  bool is_origin_failing = false;
  std::string trouble; ///< why the first starting point of the search failed; empty: none did
  long samples = 0;

  /// Returns true if further searches are not expected to find points that sampling needs. The more points there are, the more searches end
  /// at known ones while others are unknown.
  [[nodiscard]] bool is_searched_out() const { return fruitless >= 3 + needed / 4; }
};

/// Searches design points. `is_second_order` adds the probabilities of second order.
[[nodiscard]] DesignPoints find_design_points(LimitFunction& limit, bool is_second_order);

/// Starts further searches, from places away from all points in `found`, until it is searched out or the samples for searches are used up.
/// Returns true if they found a point around which sampling is needed.
bool search_on(LimitFunction& limit, DesignPoints& found);

/// Starts one more search from `start`. Returns true if it converged to a point that is not in `found`, and adds it.
bool search_again(LimitFunction& limit, const std::vector<double>& start, DesignPoints& found);

} // namespace steplap::study
