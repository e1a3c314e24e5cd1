// The second-order filter is implemented here instead of by a library, because this takes no more code and gives the same bits on every
// processor.
#include "transformer/recorder/filter.h"

#include "mbd/base/portable_math.h"

#include <cmath>
#include <iterator>
#include <numbers>
#include <stdexcept>

namespace steplap {

ChannelFilter::ChannelFilter(double frequency_class, double rate) {
  if (!is_possible(frequency_class, rate)) throw std::invalid_argument("a channel frequency class needs ten times its frequency as rate");
  const portable::SinCos half = portable::sin_cos(std::numbers::pi * k_ratio * frequency_class / rate);
  const double w = half.sin / half.cos, sum = 1.0 + std::numbers::sqrt2 * w + w * w;
  a0_ = w * w / sum;
  b1_ = -2.0 * (w * w - 1.0) / sum;
  b2_ = (-1.0 + std::numbers::sqrt2 * w - w * w) / sum;
  // Edge of the bandwidth: the gain is 1/√2 where (tan(π f/fs)/w)⁴ = √2 − 1.
  const double edge = w * std::sqrt(std::sqrt(std::numbers::sqrt2 - 1.0));
  bandwidth_ = rate / std::numbers::pi * portable::atan2(edge, 1.0);
  // The transient of the poles decays as exp(−ω0 t/√2), to 1e-12 after 3.0/CFC seconds.
  settling_ = static_cast<int>(std::ceil(3.0 * rate / frequency_class)) + 4;
}

template <class Iterator> void ChannelFilter::run(Iterator at, Iterator end) const {
  double x1 = *at, x2 = x1, y1 = x1, y2 = x1; // steady state for a constant signal, for which the gain is 1
  for (; at != end; ++at) {
    const double x = *at, y = a0_ * (x + 2.0 * x1 + x2) + b1_ * y1 + b2_ * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    *at = y1 = y;
  }
}

void ChannelFilter::apply(std::span<double> samples) const {
  if (samples.empty()) return;
  run(samples.begin(), samples.end());
  run(std::make_reverse_iterator(samples.end()), std::make_reverse_iterator(samples.begin()));
}

} // namespace steplap
