#include "tools/assess/signal_watch.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

void SignalWatch::begin(const RecordLayout& layout, double) {
  axes_ = layout.axes.size();
  for (std::size_t i = 0; i < axes_; ++i) letters_[i] = layout.axes[i].axis;
}

void SignalWatch::begin_segment(std::size_t) { samples_ = 0, is_noted_ = false; }

void SignalWatch::note(bool is_begin, double t, std::size_t axis, double value) {
  if (end_.count++ == 0) end_ = {is_begin, t, value, letters_[axis], 1};
  is_noted_ = true;
}

void SignalWatch::put(double t, const double* plain, const double* filtered) {
  for (std::size_t i = 0; i < axes_; ++i) {
    greatest_[i] = std::max(greatest_[i], std::abs(filtered[i]));
    if (samples_ < k_inspected && !is_noted_ && std::abs(plain[i]) > level_) note(true, t, i, plain[i]);
  }
  std::copy(plain, plain + axes_, last_[samples_++ % k_inspected].begin());
  t_ = t;
}

void SignalWatch::end_segment() {
  is_noted_ = false;
  for (std::size_t k = 0; k < std::min(samples_, k_inspected); ++k)
    for (std::size_t i = 0; i < axes_; ++i)
      if (!is_noted_ && std::abs(last_[k][i]) > level_) note(false, t_, i, last_[k][i]);
}

} // namespace steplap::assess
