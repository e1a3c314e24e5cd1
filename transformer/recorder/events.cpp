#include "transformer/recorder/events.h"

#include "transformer/recorder/dominant_frequency.h"

#include <algorithm>
#include <cmath>
#include <deque>

namespace steplap {

namespace {

constexpr std::size_t k_longest = std::size_t{1} << 18U; // largest number of samples of a window: a minute at 4 kHz

std::size_t greatest(std::span<const double> samples) {
  const auto found = std::max_element(samples.begin(), samples.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(found - samples.begin());
}

double peak_in_class(const std::vector<double>& samples, double frequency_class, double rate) {
  if (!ChannelFilter::is_possible(frequency_class, rate)) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> filtered = samples;
  ChannelFilter(frequency_class, rate).apply(filtered);
  return filtered[greatest(filtered)];
}

// Returns the fraction of the interval between two samples that is above the level; one of them is above, the other below.
double share_beyond(double inside, double outside, double level) { return std::clamp((inside - level) / (inside - outside), 0.0, 1.0); }

// Returns the largest difference of the integral of a signal within any second.
double largest_change(const std::vector<double>& a, double rate) {
  const auto second = static_cast<std::size_t>(std::ceil(rate));
  std::vector<double> velocity(a.size(), 0.0);
  for (std::size_t i = 1; i < a.size(); ++i) velocity[i] = velocity[i - 1] + 0.5 * (a[i - 1] + a[i]) / rate;
  std::deque<std::size_t> low, high; // samples of the last second with ascending, with descending velocities
  double most = 0.0;
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    while (!low.empty() && velocity[low.back()] >= velocity[i]) low.pop_back();
    while (!high.empty() && velocity[high.back()] <= velocity[i]) high.pop_back();
    low.push_back(i), high.push_back(i);
    while (low.front() + second < i) low.pop_front();
    while (high.front() + second < i) high.pop_front();
    most = std::max(most, velocity[high.front()] - velocity[low.front()]);
  }
  return most;
}

AxisEvent describe_axis(const Window& window, std::size_t axis) {
  const std::vector<double>& a = window.filtered[axis];
  const double step = 1.0 / window.rate;
  AxisEvent event;
  const std::size_t at = greatest(a);
  event.peak = a[at];
  event.peak_time = window.times[at];
  const double sign = event.peak < 0.0 ? -1.0 : 1.0, level = 0.1 * std::abs(event.peak);
  std::size_t from = at, to = at;
  while (from > 0 && sign * a[from - 1] >= level) --from;
  while (to + 1 < a.size() && sign * a[to + 1] >= level) ++to;
  // The signal is linear between samples, so the interval above the level ends between two of them.
  const double lead = from > 0 ? share_beyond(sign * a[from], sign * a[from - 1], level) : 0.0;
  const double tail = to + 1 < a.size() ? share_beyond(sign * a[to], sign * a[to + 1], level) : 0.0;
  event.duration = (static_cast<double>(to - from) + lead + tail) * step;
  for (std::size_t i = from; i < to; ++i) event.velocity_change += 0.5 * (a[i] + a[i + 1]) * step;
  event.velocity_change += 0.5 * sign * step * (lead * (sign * a[from] + level) + tail * (sign * a[to] + level));
  event.largest_change = std::max(std::abs(event.velocity_change), largest_change(a, window.rate));
  event.frequency = dominant_frequency(a, window.rate);
  event.at_cfc60 = peak_in_class(window.plain[axis], 60.0, window.rate);
  event.at_cfc10 = peak_in_class(window.plain[axis], 10.0, window.rate);
  return event;
}

} // namespace

ShockEvent describe_event(const Window& window, std::size_t axes) {
  ShockEvent event;
  event.begin = window.times.front();
  event.end = window.times.back();
  for (std::size_t i = 0; i < axes; ++i) {
    event.axes.push_back(describe_axis(window, i));
    if (std::abs(event.axes[i].peak) > std::abs(event.axes[event.worst].peak)) event.worst = i;
  }
  return event;
}

void ShockFinder::begin(const RecordLayout& layout, double rate) {
  axes_ = layout.axes.size();
  window_.rate = rate;
  kept_ = static_cast<std::size_t>(std::ceil(rules_.before * rate - 1e-9));
  kept_ = std::min(kept_, k_longest / 4);
  thresholds_ = rules_.each.value_or(std::array{rules_.threshold, rules_.threshold, rules_.threshold});
}

void ShockFinder::begin_segment(std::size_t line) {
  forget_all_but(0);
  is_inside_ = is_event_ = false;
  means_ = {};
  ++segment_;
  line_ = line;
}

void ShockFinder::forget_all_but(std::size_t kept) {
  const auto drop = [&](std::vector<double>& samples) {
    samples.erase(samples.begin(), samples.end() - static_cast<std::ptrdiff_t>(std::min(kept, samples.size())));
  };
  drop(window_.times);
  for (std::size_t i = 0; i < axes_; ++i) {
    drop(window_.plain[i]);
    drop(window_.filtered[i]);
  }
}

void ShockFinder::put(double t, const double* plain, const double* filtered) {
  if (!is_inside_ && window_.times.size() >= kept_ + 4096) forget_all_but(kept_); // in blocks, so that the cost is negligible
  window_.times.push_back(t);
  bool is_stirred = false;
  for (std::size_t i = 0; i < axes_; ++i) {
    window_.plain[i].push_back(plain[i]);
    window_.filtered[i].push_back(filtered[i]);
    is_stirred |= std::abs(filtered[i]) > rules_.release * thresholds_[i];
    is_event_ |= std::abs(filtered[i]) > thresholds_[i] || std::abs(means_[i].put(filtered[i], window_.rate)) > rules_.sustained[i];
  }
  if (is_stirred && !is_inside_) {
    forget_all_but(kept_ + 1);
    is_inside_ = true;
    window_.lead = window_.times.size() - 1;
  }
  if (!is_inside_) return;
  if (is_stirred) last_stir_ = t, stirred_ = window_.times.size();
  const double slack = 1e-6 / window_.rate;
  if (t - last_stir_ <= rules_.after + slack) used_ = window_.times.size();
  if (t - last_stir_ > std::max(rules_.after, rules_.merge) + slack) {
    close(false);
  } else if (window_.times.size() >= k_longest) {
    if (is_event_) return close(true);
    forget_all_but(k_longest / 2);
    used_ = stirred_ = window_.times.size(); // long above the release level without an event: an event later on begins here
    window_.lead = kept_;
  }
}

void ShockFinder::close(bool goes_on) {
  if (!is_event_) {
    is_inside_ = false;
    return forget_all_but(kept_);
  }
  Window window = window_;
  window.tail = used_ - stirred_;
  window.times.resize(used_);
  for (std::size_t i = 0; i < axes_; ++i) {
    window.plain[i].resize(used_);
    window.filtered[i].resize(used_);
  }
  ShockEvent event = describe_event(window, axes_);
  event.number = ++count_;
  event.segment = segment_;
  event.line = line_;
  event.goes_on = goes_on;
  found_(event, window);
  is_inside_ = is_event_ = false;
  forget_all_but(goes_on ? 0 : window_.times.size() - used_); // a sample belongs to one event only
}

void ShockFinder::end_segment() {
  if (is_inside_) close(false);
}

} // namespace steplap
