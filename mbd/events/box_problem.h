// Convex quadratic problems with bounds: min ½ wᵀA w + bᵀw over |w_i| ≤ c_i, A symmetric and positive semidefinite; or
// over lower_i ≤ w_i ≤ upper_i, of which one may be infinite (ropes: they pull without bound and never push).
//
// The dual of the mode problem for friction of one dimension: A the compliance of the candidates' rows, b their
// relative acceleration without friction, g = A w + b the one with it. A solution has g_i = 0 where |w_i| < c_i, and
// g_i against w_i where it is at its bound. A may be singular, as rows depend on each other (two feet of one body) or on
// driven coordinates (a zero row): g is unique all the same, and where no w within the bounds makes g_i vanish, i slides.
//
// Primal active-set method: exact after finitely many changes of the set; free variables move to their common
// minimum or, where there is none, along the direction in which the objective falls without end, to the next bound.
#pragma once

#include "mbd/base/types.h"

#include <vector>

namespace steplap {

struct BoxSolution {
  VecX w;                    ///< minimiser
  VecX g;                    ///< A w + b
  std::vector<char> is_free; ///< g_i = 0: not held at its bound by g_i
  bool is_solved = false;    ///< false: the set of bounds repeated itself
};

/// `rounding`: how much of b_i is not known.
[[nodiscard]] BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& c, const VecX& rounding);
/// lower ≤ 0 ≤ upper.
[[nodiscard]] BoxSolution solve_box_problem(const MatX& a, const VecX& b, const VecX& lower, const VecX& upper, const VecX& rounding);

} // namespace steplap
