#include "mbd/base/root_estimate.h"

#include <cmath>
#include <utility>

namespace steplap {

namespace {

constexpr int k_max_iterations = 60;

} // namespace

// Appends a row to the table of divided differences: last_[k] = f[x_{n−k}, …, x_n].
void RootEstimate::append(double x, double value) {
  double difference = value;
  for (int k = 0; k < n_; ++k) {
    const double next = (difference - last_[k]) / (x - x_[n_ - 1 - k]);
    last_[k] = difference;
    difference = next;
  }
  last_[n_] = difference;
  c_[n_] = difference;
  x_[n_++] = x;
}

void RootEstimate::add(double x, double value) {
  if (n_ < k_capacity) append(x, value);
}

// Hermite interpolation: the node is entered twice, and the first divided difference between the two is the slope.
void RootEstimate::add(double x, double value, double slope) {
  if (n_ + 2 > k_capacity) return add(x, value);
  append(x, value);
  double difference = slope;
  last_[0] = value;
  for (int k = 1; k < n_; ++k) {
    const double next = (difference - last_[k]) / (x - x_[n_ - 1 - k]);
    last_[k] = difference;
    difference = next;
  }
  last_[n_] = difference;
  c_[n_] = difference;
  x_[n_++] = x;
}

RootEstimate::Value RootEstimate::at(double x) const {
  Value p{c_[n_ - 1], 0.0};
  for (int k = n_ - 2; k >= 0; --k) {
    p.slope = p.slope * (x - x_[k]) + p.value;
    p.value = p.value * (x - x_[k]) + c_[k];
  }
  return p;
}

// Finds the root of the interpolating polynomial by Newton's method, with a bisection step where Newton's would leave the bracket.
double RootEstimate::root(double low, double high, double resolution) const {
  const double at_low = at(low).value, at_high = at(high).value;
  double x = low + (high - low) * at_low / (at_low - at_high);
  if (!(x > low && x < high)) x = 0.5 * (low + high);
  for (int iteration = 0; iteration < k_max_iterations; ++iteration) {
    const Value p = at(x);
    (p.value >= 0.0 ? low : high) = x;
    double next = x - p.value / p.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (high - low <= resolution) return next;
    const double change = std::abs(next - x);
    x = next;
    if (change <= resolution) break;
  }
  return x;
}

} // namespace steplap
