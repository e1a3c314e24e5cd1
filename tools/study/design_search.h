// The search for a design point: Hasofer and Lind's, Rackwitz and Fiessler's iteration with a line search (Zhang and
// Der Kiureghian, 1997).
//
// At u, with the gradient a of g, the plane that touches g there is zero nearest to the origin at
//   w = a (a·u - g)/|a|².
// A step goes towards w, as far as m(u) = |u|²/2 + c |g| falls, with c = 2 max(|u|, |w|)/|a|. Gradients are
// central differences, asked for in one batch, so that all processors have something to do.
#pragma once

#include "tools/study/limit_function.h"

namespace steplap::study {

struct SearchEnd {
  std::vector<double> u;        ///< where it ended
  std::vector<double> gradient; ///< there
  double g = 0.0;               ///< there
  bool is_known = false;        ///< it was on its way to a place that is known already
  bool is_bad = false;          ///< a run without result ended it
  std::string trouble;          ///< why it did not arrive; "" if it did
};

/// From `start`; ends early where it heads for one of `known`, or when samples from `limit` reach `last`.
[[nodiscard]] SearchEnd search_design_point(LimitFunction& limit, std::vector<double> start, const std::vector<std::vector<double>>& known,
                                            long last);

/// Central differences with the step `h`; nothing where a run has no result.
[[nodiscard]] std::optional<std::vector<double>> gradient_at(LimitFunction& limit, const std::vector<double>& u, double h);

[[nodiscard]] double distance_between(const std::vector<double>& a, const std::vector<double>& b);

} // namespace steplap::study
