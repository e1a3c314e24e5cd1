#include "tools/assess/signal_watch.h"

#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

namespace {

// length of the inspected ends, s: half a period of 10 Hz, so that a zero crossing at the end does not hide a shock
constexpr double k_edge = 0.05;
constexpr std::size_t k_least_edge = 3;     // smallest length, samples; a single one may be a zero crossing
constexpr double k_quiet = 0.02;            // length of the outermost part, s: if nothing is felt there, a shock begins or ends after it
constexpr double k_near = 0.5;              // length of the interval next to an end, to which it is compared, s
constexpr double k_rises = 5.0;             // ratio of the largest values in both that noise does not reach
constexpr double k_felt = 0.05 * k_gravity; // smallest magnitude of a shock at an end, m/s²

} // namespace

void SignalWatch::begin(const RecordLayout& layout, double rate) {
  axes_ = layout.axes.size();
  rate_ = rate;
  for (std::size_t i = 0; i < axes_; ++i) letters_[i] = layout.axes[i].axis;
  edge_ = std::max(k_least_edge, static_cast<std::size_t>(std::ceil(k_edge * rate)));
  near_ = edge_ + static_cast<std::size_t>(std::ceil(k_near * rate));
  last_.assign(near_, {});
}

void SignalWatch::begin_segment(std::size_t) {
  samples_ = 0;
  means_ = {};
}

void SignalWatch::put(double t, const double* plain, const double* filtered) {
  for (std::size_t i = 0; i < axes_; ++i) {
    greatest_[i] = std::max(greatest_[i], std::abs(filtered[i]));
    sustained_[i] = std::max(sustained_[i], std::abs(means_[i].put(filtered[i], rate_)));
  }
  if (samples_ == 0) begin_ = t;
  std::copy(plain, plain + axes_, last_[samples_++ % near_].begin());
  t_ = t;
  if (samples_ == near_) inspect(true);
}

void SignalWatch::end_segment() {
  if (samples_ < near_) inspect(true);
  inspect(false);
}

// Returns the largest magnitude of samples number `from` to `to` − 1 in the buffer, counted from the oldest.
double SignalWatch::largest(std::size_t axis, std::size_t from, std::size_t to) const {
  const std::size_t oldest = samples_ - std::min(samples_, near_);
  double most = 0.0;
  for (std::size_t k = oldest + from; k < oldest + to; ++k) most = std::max(most, std::abs(last_[k % near_][axis]));
  return most;
}

void SignalWatch::inspect(bool is_begin) {
  const std::size_t kept = std::min(samples_, near_), edge = std::min(edge_, kept);
  for (std::size_t i = 0; i < axes_; ++i) {
    const double at_end = is_begin ? largest(i, 0, edge) : largest(i, kept - edge, kept);
    const double next = is_begin ? largest(i, edge, kept) : largest(i, 0, kept - edge);
    if (at_end <= level_ && (at_end <= k_felt || kept < near_ || at_end <= k_rises * next)) continue;
    const std::size_t outer = std::min(edge, std::max(k_least_edge, static_cast<std::size_t>(std::ceil(k_quiet * rate_))));
    if (outer < edge && (is_begin ? largest(i, 0, outer) : largest(i, kept - outer, kept)) <= k_felt) continue;
    if (end_.count++ == 0) end_ = {is_begin, is_begin ? begin_ : t_, at_end, letters_[i], 1};
    return;
  }
}

} // namespace steplap::assess
