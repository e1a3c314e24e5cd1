// EventFinder: locates the root inside a bracket to rounding.
#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_max_samples = 130;
constexpr int k_free_samples = 60;    // maximum number of samples by interpolation; then at most 70 bisections follow
constexpr int k_patience = 6;         // consecutive samples that may fail to halve the bracket before a bisection
constexpr double k_least_reach = 4.0; // smallest half-width of the bracket, in spacings of floating-point numbers at t
// Location error of the root, as fraction of the tolerance relative to the step; errors of the motion are larger.
constexpr double k_tolerance_share = 1e-6;
constexpr double k_most_tolerance = 1e-3; // larger tolerances, used only to obtain steps of a fixed length, do not increase this error
// an estimate that changes by more than this multiple of the predicted error is affected by rounding
constexpr double k_unexpected = 16.0;
constexpr double k_most_rounding = 1e-8; // upper limit of such a change, in θ; a larger change is not rounding
constexpr double k_wider = 8.0;          // factor on the half-width if the root lies outside the bracket
constexpr int k_polish = 3;              // secant steps after the half-width had to be increased
constexpr double k_closed = 4.0;         // width of a closed bracket, in half-widths

} // namespace

// Root finding. Polynomials through the last samples of the fired functions estimate the next root. The estimate has converged when its
// error is below the spacing of t, a millionth of the tolerance, or the rounding of the values. Then one sample just beyond it closes the
// bracket, if value and slope there show that the root lies within the half-width; otherwise one sample on either side does.
void EventFinder::locate_root(Integrator& integrator, Dynamics& dynamics) {
  const double spacing =
      2.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(integrator.t1()), integrator.h()) / integrator.h();
  history_[0] = low_;
  history_[1] = high_;
  history_count_ = 2;
  const RootIteration at_first{
      .half_width = std::max(k_least_reach * spacing, k_tolerance_share * std::min(integrator.tolerance(), k_most_tolerance))};
  iteration_ = at_first;
  double halved = high_.theta - low_.theta;
  int since_halved = 0, polished = 0;
  for (int count = 0; count < k_max_samples; ++count) {
    const double width = high_.theta - low_.theta;
    if (width <= std::max(spacing, k_closed * at_first.half_width)) return;
    // An increased half-width may exceed the rounding error, so the bracket is refined by secants.
    const bool is_closed = count < k_free_samples && iteration_.is_converged && width <= k_closed * iteration_.half_width;
    if (is_closed && polished++ == k_polish) return;
    double theta = 0.5 * (low_.theta + high_.theta);
    const bool is_known_beyond = high_.theta - iteration_.root <= 2.0 * iteration_.half_width;
    const bool is_below = is_known_beyond && iteration_.root - low_.theta > high_.theta - iteration_.root;
    // Bisection after k_patience unsuccessful samples, because a kink or a pole in the bracket may stall interpolation.
    if (is_closed) theta = secant_estimate();
    else if (iteration_.is_converged && count < k_free_samples)
      theta = is_below ? iteration_.root - iteration_.half_width : iteration_.root + iteration_.half_width;
    else if (since_halved < k_patience && count < k_free_samples) theta = next_estimate(theta);
    else iteration_ = at_first;
    const double edge = std::min(0.5 * width, 0.5 * spacing);
    theta = std::clamp(theta, low_.theta + edge, high_.theta - edge);
    sample_at(integrator, dynamics, theta, middle_);
    history_[static_cast<std::size_t>(count + 2) % k_history] = middle_;
    history_count_ = std::min(history_count_ + 1, k_history);
    fired_before_ = fired_;
    const bool is_beyond = find_sign_changes(low_, middle_);
    if (!is_beyond) fired_ = fired_before_;
    std::swap(is_beyond ? high_ : low_, middle_);
    if (is_beyond && iteration_.is_converged && is_root_just_before(high_, k_closed * at_first.half_width)) return;
    if (iteration_.is_converged && !is_closed && is_beyond == is_below) { // the root is still on the same side of the estimate
      iteration_.root = theta;
      iteration_.half_width *= k_wider;
      if (iteration_.half_width > k_most_rounding) iteration_ = at_first; // the estimate had not converged
    }
    since_halved = high_.theta - low_.theta < 0.5 * halved ? 0 : since_halved + 1;
    if (since_halved == 0) halved = high_.theta - low_.theta;
  }
}

// Returns true if the roots of all fired functions lie within `half_width` before the sample, by their slopes, or by chords over the
// bracket if slopes are unknown.
bool EventFinder::is_root_just_before(const Sample& beyond, double half_width) const {
  return std::all_of(fired_.begin(), fired_.end(), [&](int slot) {
    const double chord = (beyond.event_value[slot] - low_.event_value[slot]) / (beyond.theta - low_.theta);
    const double slope = std::isnan(beyond.rate[slot]) ? chord : beyond.rate[slot];
    return slope < 0.0 && beyond.event_value[slot] >= half_width * slope;
  });
}

double EventFinder::secant_estimate() const {
  double share = 1.0;
  for (const int slot : fired_) share = std::min(share, low_.event_value[slot] / (low_.event_value[slot] - high_.event_value[slot]));
  // The ends are avoided, because the values there are rounding errors.
  return low_.theta + std::clamp(share, 0.1, 0.9) * (high_.theta - low_.theta);
}

// Returns the next estimate of the first root; `middle` if none can be made.
double EventFinder::next_estimate(double middle) {
  double theta = high_.theta;
  for (const int slot : fired_) {
    estimate_.clear();
    for (std::size_t i = 0; i < history_count_; ++i) {
      const Sample& sample = history_[i];
      const double w = sample.event_value[slot], slope = sample.rate[slot];
      if (std::isnan(slope)) estimate_.add(sample.theta, w);
      else estimate_.add(sample.theta, w, slope);
    }
    theta = std::min(theta, estimate_.root(low_.theta, high_.theta, 0.25 * iteration_.half_width));
  }
  if (std::isnan(theta)) return middle;
  // The distance to the previous estimate is the error of that estimate. The ratio of successive errors predicts the error of the present
  // one. A distance much larger than predicted is rounding.
  const double distance = std::abs(theta - iteration_.root);
  if (iteration_.count >= 3 && distance > k_unexpected * iteration_.expected && distance < k_most_rounding) {
    iteration_.half_width = std::max(iteration_.half_width, 2.0 * distance);
    iteration_.is_converged = true;
  }
  iteration_.expected = iteration_.count >= 2 ? 4.0 * distance * std::min(1.0, distance / iteration_.distance) : 1.0;
  if (iteration_.expected <= 0.5 * iteration_.half_width) iteration_.is_converged = true;
  iteration_.distance = distance;
  iteration_.root = theta;
  ++iteration_.count;
  return theta;
}

} // namespace steplap
