// EventFinder: the root inside a bracket, to the rounding of the values.
#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_max_looks = 130;
constexpr int k_free_looks = 60;           // halving alone from then on: the last 70 close any bracket
constexpr int k_patience = 6;              // looks that need not halve the bracket
constexpr double k_least_reach = 4.0;      // in spacings of t;
constexpr double k_tolerance_share = 1e-6; // … or of the tolerance, by which the motion is off anyway: in parts of the step;
constexpr double k_most_tolerance = 1e-3;  // larger ones are given to have steps of a fixed length
constexpr double k_unexpected = 16.0;      // times the error expected
constexpr double k_most_rounding = 1e-8;   // of the step: beyond it an error is not rounding
constexpr double k_wider = 8.0;            // a reach that did not find the other side
constexpr int k_polish = 3;                // secants inside a bracket that was closed by a wider reach
constexpr double k_closed = 4.0;           // a bracket of so many times its ends' uncertainty

} // namespace

// What is known of the fired values so far goes into polynomials; the first of their roots is looked at next.
// Once that is known to the spacing of t, a millionth of the tolerance, or the rounding of the values, a look beyond it
// closes the bracket, if the values there and their slopes say that the root lies as near as that; else one on either side.
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
    // What reach was needed may have been too wide for what there is of rounding.
    const bool is_closed = looks < k_free_looks && aim_.is_settled && width <= k_closed * aim_.reach;
    if (is_closed && polished++ == k_polish) return;
    double theta = 0.5 * (low_.theta + high_.theta);
    const bool is_known_beyond = high_.theta - aim_.root <= 2.0 * aim_.reach;
    const bool is_below = is_known_beyond && aim_.root - low_.theta > high_.theta - aim_.root;
    // A kink or a pole inside the bracket cannot stall the search for long.
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
    if (aim_.is_settled && !is_closed && is_beyond == is_below) { // not yet on the other side
      aim_.root = theta;
      aim_.reach *= k_wider;
      if (aim_.reach > k_most_rounding) aim_ = at_first; // it was not settled
    }
    since_halved = high_.theta - low_.theta < 0.5 * halved ? 0 : since_halved + 1;
    if (since_halved == 0) halved = high_.theta - low_.theta;
  }
}

// By the slopes of the values that have fired, or where they are not known, of their chords over the bracket.
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
  // Not too near an end, where rounding has made the value what it is.
  return low_.theta + std::clamp(share, 0.1, 0.9) * (high_.theta - low_.theta);
}

// `middle`: where no estimate can be made.
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
  // The last look was at such a root too, and off by the distance to this one; how much nearer that is than the
  // last distance tells how near the next one would be. A distance larger than was to be expected is rounding.
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
