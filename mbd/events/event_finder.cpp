#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_usual_parts = 128; // as many as a survey may hold without allocating

} // namespace

EventFinder::EventFinder(const System& system, int max_dimension)
    : system_(system), slots_(system.watch_count), y_(max_dimension, 0.0), dy_(max_dimension, 0.0), armed_(slots_, 1), armed_before_(slots_, 1) {
  slack_.assign(slots_, 0.0);
  near_.reserve(slots_);
  fired_.reserve(slots_);
  fired_before_.reserve(slots_);
  parts_.reserve(k_usual_parts);
  for (Look& look : place_) look.watch.resize(slots_), look.rate.resize(slots_);
}

void EventFinder::watch_at(Integrator& integrator, Dynamics& dynamics, double theta, Look& look) {
  integrator.dense(dynamics, theta, y_.data());
  const double t = integrator.t0() + theta * integrator.h();
  dynamics.look_rates(t, y_.data(), dy_.data(), is_merged_near_);
  look.theta = theta;
  look.watch = dynamics.watch();
  look.rate = dynamics.watch_rate();
  for (double& rate : look.rate) rate *= integrator.h();
}

// An end of the step.
void EventFinder::look_at_end(const Integrator& integrator, bool is_last, Look& look) {
  look.theta = is_last ? 1.0 : 0.0;
  look.watch = is_last ? integrator.watch1() : integrator.watch0();
  look.rate = is_last ? integrator.watch_rate1() : integrator.watch_rate0();
  for (double& rate : look.rate) rate *= integrator.h();
}

EventFinder::Suspicion EventFinder::suspicion(Integrator& integrator, const std::vector<char>& fresh) {
  near_.clear();
  WatchNodes& nodes = integrator.watch_nodes();
  nodes.close(integrator.watch0().data(), integrator.watch1().data());
  Suspicion worst = Suspicion::none;
  const double h = integrator.h();
  for (int i = 0; i < slots_; ++i) {
    const double low = nodes.low(i);
    if (2.0 * low > nodes.high(i)) continue; // far
    const double w0 = integrator.watch0()[i], w1 = integrator.watch1()[i];
    if (w1 < 0.0) {
      // A plain crossing. A value that is fresh, or negative from the start (rounding, or the projection at another
      // event), has to be followed.
      const bool is_plain = !fresh[i] && w0 >= 0.0 && nodes.crosses_once(i);
      worst = std::max(worst, is_plain ? Suspicion::at_end : Suspicion::inside);
      if (!is_plain) near_.push_back(i);
      continue;
    }
    const double start = fresh[i] ? std::max(w0, 0.0) : w0;
    if (nodes.is_surely_positive(i, {start, h * integrator.watch_rate0()[i]}, {w1, h * integrator.watch_rate1()[i]})) continue;
    near_.push_back(i);
    worst = Suspicion::inside;
  }
  return worst;
}

// Slots that were believed positive in `low` and are negative in `high` go to fired_.
bool EventFinder::crosses(const Look& low, const Look& high) {
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (armed_[i] && high.watch[i] < 0.0 && low.watch[i] >= 0.0) fired_.push_back(i);
  return !fired_.empty();
}

bool EventFinder::falls(const Look& low, const Look& high) {
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (armed_[i] && high.watch[i] < (high.theta < 1.0 ? -slack_[i] : 0.0) && low.watch[i] >= -slack_[i]) fired_.push_back(i);
  return !fired_.empty();
}

void EventFinder::set_slack(const Integrator& integrator, const Dynamics& dynamics) {
  const double slack = integrator.rate_accuracy(dynamics);
  for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
    const FrictionUnit& unit = system_.frictions[f];
    const bool is_rate = unit.friction->dimension() == 1 && dynamics.state().friction[f].phase == FrictionPhase::slip;
    slack_[unit.watch] = is_rate ? slack : 0.0;
  }
}

// Joints that are merged and certain to hold through the step need not be looked at in it.
bool EventFinder::is_any_merged_near(const Integrator& integrator, const Dynamics& dynamics) const {
  const std::vector<int>& merged = dynamics.layout().merged;
  return std::any_of(merged.begin(), merged.end(), [&](int f) {
    const int first = system_.frictions[f].watch;
    const auto is_of_joint = [first](int slot) { return slot >= first && slot < first + k_friction_watches; };
    return integrator.watch1()[first] < 0.0 || integrator.watch1()[first + 1] < 0.0 ||
           std::any_of(near_.begin(), near_.end(), is_of_joint);
  });
}

EventFinder::Bracket EventFinder::bracket_whole(const Integrator& integrator) {
  look_at_end(integrator, false, low_);
  look_at_end(integrator, true, high_);
  std::fill(armed_.begin(), armed_.end(), 1);
  return crosses(low_, high_) ? Bracket::found : Bracket::none;
}

bool EventFinder::find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  is_step_withdrawn_ = false;
  if (slots_ == 0) return false;
  const Suspicion suspected = suspicion(integrator, fresh);
  if (suspected == Suspicion::none) return false;
  is_step_withdrawn_ = !integrator.bears_look(dynamics);
  if (is_step_withdrawn_) return false;
  set_slack(integrator, dynamics);
  is_merged_near_ = is_any_merged_near(integrator, dynamics);
  const Bracket bracket = suspected == Suspicion::inside ? survey(integrator, dynamics, fresh)
                                                         : bracket_whole(integrator);
  if (bracket == Bracket::none) return false;
  if (bracket == Bracket::found) close_in(integrator, dynamics);
  theta_ = high_.theta;
  integrator.dense(dynamics, theta_, y_.data());
  return true;
}

} // namespace steplap
