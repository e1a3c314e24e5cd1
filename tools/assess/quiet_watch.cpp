#include "tools/assess/quiet_watch.h"

#include <algorithm>
#include <cmath>

namespace steplap::assess {

void QuietWatch::begin(const RecordLayout& layout, double rate) {
  axes_ = layout.axes.size();
  window_.rate = rate;
  constexpr double k_most = 65536.0; // samples
  before_ = static_cast<std::size_t>(std::min(k_most, std::ceil(rules_.before * rate)));
  after_ = static_cast<std::size_t>(std::min(k_most, std::ceil(std::max(rules_.after, rules_.merge) * rate)));
}

void QuietWatch::begin_segment(std::size_t line) {
  ++segment_;
  line_ = line;
  dropped_ = next_ = 0;
  window_.times.clear();
  for (std::size_t i = 0; i < axes_; ++i) window_.plain[i].clear(), window_.filtered[i].clear();
}

// A sample is looked at when all that may make it part of an event, before and after it, has been seen.
void QuietWatch::put(double t, const double* plain, const double* filtered) {
  const std::size_t index = dropped_ + window_.times.size(), reach = before_ + after_;
  window_.times.push_back(t);
  bool is_beyond = false;
  for (std::size_t i = 0; i < axes_; ++i) {
    window_.plain[i].push_back(plain[i]);
    window_.filtered[i].push_back(filtered[i]);
    is_beyond |= std::abs(filtered[i]) > rules_.threshold;
  }
  if (is_beyond) {
    next_ = index + 1 + reach; // what lies between belongs to the event, or its window would meet that of the event
  } else if (index >= next_ + reach) {
    look_at(next_++);
  }
  if (window_.times.size() < 4 * reach + 8192) return; // seldom, so that dropping costs nothing
  const std::size_t kept_from = std::min(next_, index + 1) - std::min(next_, before_),
                    gone = kept_from > dropped_ ? kept_from - dropped_ : 0;
  const auto drop = [&](std::vector<double>& samples) {
    samples.erase(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(gone));
  };
  drop(window_.times);
  for (std::size_t i = 0; i < axes_; ++i) drop(window_.plain[i]), drop(window_.filtered[i]);
  dropped_ += gone;
}

void QuietWatch::end_segment() {
  while (next_ < dropped_ + window_.times.size()) look_at(next_++);
}

void QuietWatch::look_at(std::size_t index) {
  const std::size_t at = index - dropped_;
  for (std::size_t axis = 0; axis < axes_; ++axis) {
    const double size = std::abs(window_.filtered[axis][at]);
    if (!(size > best_[axis].peak)) continue;
    Stretch& best = best_[axis];
    best.peak = size;
    best.segment = segment_, best.line = line_;
    const std::size_t first = at - std::min(at, before_);
    const std::size_t last = std::min(window_.times.size(), at + after_ + 1);
    const auto part = [&](const std::vector<double>& from, std::vector<double>& to) {
      to.assign(from.begin() + static_cast<std::ptrdiff_t>(first), from.begin() + static_cast<std::ptrdiff_t>(last));
    };
    best.window.rate = window_.rate;
    part(window_.times, best.window.times);
    for (std::size_t i = 0; i < axes_; ++i)
      part(window_.plain[i], best.window.plain[i]), part(window_.filtered[i], best.window.filtered[i]);
  }
}

std::vector<QuietWatch::Stretch> QuietWatch::greatest(double least) const {
  std::vector<const Stretch*> order;
  for (const Stretch& each : best_)
    if (each.peak >= least && each.window.times.size() > 1) order.push_back(&each);
  std::stable_sort(order.begin(), order.end(), [](const Stretch* a, const Stretch* b) { return a->peak > b->peak; });
  std::vector<Stretch> kept;
  for (const Stretch* each : order) {
    const auto meets = [&](const Stretch& other) {
      return each->segment == other.segment && each->window.times.front() <= other.window.times.back() &&
             other.window.times.front() <= each->window.times.back();
    };
    if (std::none_of(kept.begin(), kept.end(), meets)) kept.push_back(*each);
  }
  std::sort(kept.begin(), kept.end(), [](const Stretch& a, const Stretch& b) {
    return a.segment != b.segment ? a.segment < b.segment : a.window.times.front() < b.window.times.front();
  });
  return kept;
}

} // namespace steplap::assess
