// Convex quadratic problem with bounds: min ½ wᵀA w + bᵀw over |w_i| ≤ c_i, or over lower_i ≤ w_i ≤ upper_i, one of which may be infinite
// (the tension of a rope has only the lower bound zero). A is symmetric and positive semidefinite.
//
// It is the dual of the mode problem for one-dimensional friction: A is the compliance of the rows of the candidates, b their relative
// acceleration without friction, and g = A w + b the one with friction. In the solution g_i = 0 if |w_i| < c_i (stick), and g_i is opposed
// to w_i at its bound (slip). A may be singular: rows may be dependent (two feet of one body) or act on driven coordinates (a zero row). g
// is still unique. If no w within the bounds makes g_i vanish, element i slides.
//
// Method: primal active set, exact after finitely many changes of the set. Free variables move to their common minimum. If the objective is
// unbounded below, they move along the direction of decrease to the next bound.
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

/// Solution of the problem.
struct BoxSolution {
  VecX w;                    ///< minimiser
  VecX g;                    ///< A w + b
  std::vector<char> is_free; ///< g_i = 0 up to rounding: no bound is active
  bool is_solved = false;    ///< false: no solution was found, because the active sets repeated (by rounding)
};

/// Solves the problem with |w_i| ≤ c_i. `rounding`: error of each b_i.
[[nodiscard]] BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& c, const VecX& rounding);
/// Solves the problem with separate bounds. Precondition: lower ≤ 0 ≤ upper.
[[nodiscard]] BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& lower, const VecX& upper, const VecX& rounding);

} // namespace steplap
