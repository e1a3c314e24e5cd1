// Searches a design point by the iteration of Hasofer-Lind and Rackwitz-Fiessler with a line search (Zhang and Der Kiureghian, 1997).
//
// At u, with the gradient a of g, the zero of the linearised g closest to the origin is
//
//   w = a (a·u - g)/|a|².
//
// A step goes towards w as long as m(u) = |u|²/2 + c |g| decreases, with c = 2 max(|u|, |w|)/|a|. Gradients are central differences
// evaluated in one batch, which uses all processors.
#pragma once

#include "tools/study/limit_function.h"

namespace steplap::study {

/// Result of a search.
struct SearchEnd {
  std::vector<double> u;        ///< last point in standard normal space
  std::vector<double> gradient; ///< gradient of g at u
  double g = 0.0;               ///< value of g at u
  bool is_known = false;        ///< true if the search ended because it approached a known design point
  bool is_bad = false;          ///< true if a run without a result ended the search
  std::string trouble;          ///< reason why the search did not converge; "" if it did
};

/// Searches from `start`. Ends early if it approaches one of `known`, or when the samples taken from `limit` reach number `last`.
[[nodiscard]] SearchEnd search_design_point(LimitFunction& limit, std::vector<double> start, const std::vector<std::vector<double>>& known,
                                            long last);

/// Returns the gradient by central differences with step `h`; nothing if a run has no result.
[[nodiscard]] std::optional<std::vector<double>> gradient_at(LimitFunction& limit, const std::vector<double>& u, double h);

/// Returns the Euclidean distance.
[[nodiscard]] double distance_between(const std::vector<double>& a, const std::vector<double>& b);

} // namespace steplap::study
