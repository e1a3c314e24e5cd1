// Types that the search for rest and its results share.
#pragma once

namespace steplap {

/// Largest component of a motion: coordinate 0, 1, 2 (x, y, θ) of a body, and its sign.
struct MotionPart {
  int body = 0, coordinate = 0;
  double sign = 1.0;
};

/// Matrices of the search for rest; `by_size`: sparse for large models.
enum class RestAlgebra { by_size, dense, sparse };

} // namespace steplap
