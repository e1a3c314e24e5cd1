#include "elements/step_lap/patch/gauss_rule.h"

#include "mbd/base/portable_math.h"

#include <numbers>
#include <utility>

namespace steplap {

// Finds the nodes by Newton's method on the Legendre polynomial.
void gauss_rule(int count, double* x, double* w) {
  for (int i = 0; i < count; ++i) {
    double z = portable::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1;
    for (int pass = 0; pass < 8; ++pass) {
      double p = 1, before = 0;
      for (int n = 1; n <= count; ++n) before = std::exchange(p, ((2 * n - 1) * z * p - (n - 1) * before) / n);
      slope = count * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    x[i] = 0.5 * (1 + z);
    w[i] = 1 / ((1 - z * z) * slope * slope);
  }
}

} // namespace steplap
