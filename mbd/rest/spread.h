// Pseudo-random vectors as starting points of iterations.
#pragma once

#include "mbd/base/types.h"

namespace steplap {

class Spread {
public:
  /// Returns a vector with components between −½ and ½, the same in every run.
  VecX vector(Eigen::Index n) {
    VecX x(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      at_ = at_ * 6364136223846793005ULL + 1442695040888963407ULL;
      x[i] = static_cast<double>(at_ >> 11) / 9007199254740992.0 - 0.5;
    }
    return x;
  }

private:
  unsigned long long at_ = 88172645463325252ULL;
};

} // namespace steplap
