// EventFinder: locates the root inside a bracket to rounding.
#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_max_looks = 130;
constexpr int k_free_looks = 60;           // after these only bisection is used; the remaining 70 close any bracket
constexpr int k_patience = 6;              // evaluations that need not halve the bracket
constexpr double k_least_reach = 4.0;      // in spacings of t, the difference of neighbouring floating-point times
constexpr double k_tolerance_share = 1e-6; // share of the tolerance, relative to the step: errors of the motion are larger anyway
constexpr double k_most_tolerance = 1e-3;  // larger tolerances only serve to get steps of a fixed length
constexpr double k_unexpected = 16.0;      // factor on the expected error; a larger change of the estimate is rounding
constexpr double k_most_rounding = 1e-8;   // in θ; a larger change is not rounding
constexpr double k_wider = 8.0;            // factor on the half-width if the root is not inside
constexpr int k_polish = 3;                // secant steps inside a bracket that needed a larger half-width
constexpr double k_closed = 4.0;           // width of a closed bracket, in half-widths

} // namespace

// Root finding. Polynomials through all samples of the fired functions estimate the next root. Once the estimate is known to the spacing of
// t, a millionth of the tolerance, or the rounding of the values, one sample just beyond it closes the bracket, if its value and slope show
// that the root is that near. Otherwise one sample on either side does.
void EventFinder::close_in(Integrator& integrator, Dynamics& dynamics) {
  const double spacing =
      2.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(integrator.t1()), integrator.h()) / integrator.h();
  known_[0] = low_;
  known_[1] = high_;
  known_count_ = 2;
  const Aim at_first{.reach = std::max(k_least_reach * spacing, k_tolerance_share * std::min(integrator.tolerance(), k_most_tolerance))};
  aim_ = at_first;
  double halved = high_.theta - low_.theta;
  int since_halved = 0, polished = 0;
  for (int looks = 0; looks < k_max_looks; ++looks) {
    const double width = high_.theta - low_.theta;
    if (width <= std::max(spacing, k_closed * at_first.reach)) return;
    // A half-width that was increased may be larger than rounding, so the bracket is refined by secants.
    const bool is_closed = looks < k_free_looks && aim_.is_settled && width <= k_closed * aim_.reach;
    if (is_closed && polished++ == k_polish) return;
    double theta = 0.5 * (low_.theta + high_.theta);
    const bool is_known_beyond = high_.theta - aim_.root <= 2.0 * aim_.reach;
    const bool is_below = is_known_beyond && aim_.root - low_.theta > high_.theta - aim_.root;
    // A kink or a pole inside the bracket must not stall the search: bisection follows after k_patience evaluations.
    if (is_closed) theta = first_secant();
    else if (aim_.is_settled && looks < k_free_looks) theta = is_below ? aim_.root - aim_.reach : aim_.root + aim_.reach;
    else if (since_halved < k_patience && looks < k_free_looks) theta = next_look(theta);
    else aim_ = at_first;
    const double edge = std::min(0.5 * width, 0.5 * spacing);
    theta = std::clamp(theta, low_.theta + edge, high_.theta - edge);
    watch_at(integrator, dynamics, theta, middle_);
    known_[static_cast<std::size_t>(looks + 2) % k_most_known] = middle_;
    known_count_ = std::min(known_count_ + 1, k_most_known);
    fired_before_ = fired_;
    const bool is_beyond = crosses(low_, middle_);
    if (!is_beyond) fired_ = fired_before_;
    std::swap(is_beyond ? high_ : low_, middle_);
    if (is_beyond && aim_.is_settled && is_root_just_before(high_, k_closed * at_first.reach)) return;
    if (aim_.is_settled && !is_closed && is_beyond == is_below) { // the root is still on the same side
      aim_.root = theta;
      aim_.reach *= k_wider;
      if (aim_.reach > k_most_rounding) aim_ = at_first; // the estimate had not converged
    }
    since_halved = high_.theta - low_.theta < 0.5 * halved ? 0 : since_halved + 1;
    if (since_halved == 0) halved = high_.theta - low_.theta;
  }
}

// Returns true if the roots of all fired functions lie within `reach` before the sample, by their slopes, or by chords over the bracket if
// slopes are unknown.
bool EventFinder::is_root_just_before(const Look& beyond, double reach) const {
  return std::all_of(fired_.begin(), fired_.end(), [&](int slot) {
    const double chord = (beyond.watch[slot] - low_.watch[slot]) / (beyond.theta - low_.theta);
    const double slope = std::isnan(beyond.rate[slot]) ? chord : beyond.rate[slot];
    return slope < 0.0 && beyond.watch[slot] >= reach * slope;
  });
}

double EventFinder::first_secant() const {
  double share = 1.0;
  for (const int slot : fired_) share = std::min(share, low_.watch[slot] / (low_.watch[slot] - high_.watch[slot]));
  // Keep away from the ends, where the values are rounding.
  return low_.theta + std::clamp(share, 0.1, 0.9) * (high_.theta - low_.theta);
}

// Returns the next estimate of the first root; `middle` if none can be made.
double EventFinder::next_look(double middle) {
  double theta = high_.theta;
  for (const int slot : fired_) {
    estimate_.clear();
    for (std::size_t i = 0; i < known_count_; ++i) {
      const Look& look = known_[i];
      const double w = look.watch[slot], slope = look.rate[slot];
      if (std::isnan(slope)) estimate_.add(look.theta, w);
      else estimate_.add(look.theta, w, slope);
    }
    theta = std::min(theta, estimate_.root(low_.theta, high_.theta, 0.25 * aim_.reach));
  }
  if (std::isnan(theta)) return middle;
  // The previous sample was at an estimate too, so the distance between the estimates is its error. The ratio of this error to the one
  // before predicts the error of the present estimate. A distance much larger than predicted is rounding.
  const double distance = std::abs(theta - aim_.root);
  if (aim_.looks >= 3 && distance > k_unexpected * aim_.expected && distance < k_most_rounding) {
    aim_.reach = std::max(aim_.reach, 2.0 * distance);
    aim_.is_settled = true;
  }
  aim_.expected = aim_.looks >= 2 ? 4.0 * distance * std::min(1.0, distance / aim_.distance) : 1.0;
  if (aim_.expected <= 0.5 * aim_.reach) aim_.is_settled = true;
  aim_.distance = distance;
  aim_.root = theta;
  ++aim_.looks;
  return theta;
}

} // namespace steplap
