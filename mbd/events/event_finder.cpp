#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_usual_parts = 128; // number of parts that a survey holds without allocation
// Factor on the constraint residual before projection. Dense output inside a step has the same error in the joints, and larger ones in
// measurements with longer levers.
constexpr double k_off_joints = 10.0;

} // namespace

EventFinder::EventFinder(const System& system, int max_dimension)
    : system_(system), slots_(system.watch_count), y_(max_dimension, 0.0), dy_(max_dimension, 0.0), armed_(slots_, 1),
      armed_before_(slots_, 1) {
  slack_.assign(slots_, 0.0);
  near_.reserve(slots_);
  curves_.reserve(slots_);
  merged_.assign(slots_, 0);
  fired_.reserve(slots_);
  fired_before_.reserve(slots_);
  parts_.reserve(k_usual_parts);
  for (const Unit& unit : system.units)
    for (int w = 0; w < unit.watch_count; ++w) {
      const WatchKind kind = unit.group->watch_kind(w);
      if (kind != WatchKind::exact) (kind == WatchKind::place ? place_slots_ : rate_slots_).push_back(unit.watch + w);
    }
  is_of_joint_.assign(slots_, 0);
  for (const FrictionUnit& unit : system.frictions)
    if (unit.friction->dimension() == 3) std::fill_n(is_of_joint_.begin() + unit.watch, k_friction_watches, 1);
  for (Look& look : place_) look.watch.resize(slots_), look.rate.resize(slots_);
}

void EventFinder::watch_at(Integrator& integrator, Dynamics& dynamics, double theta, Look& look) {
  integrator.dense(dynamics, theta, y_.data());
  const double t = integrator.t0() + theta * integrator.h();
  dynamics.evaluate(is_merged_near_ ? Request::stage_and_joints : Request::stage_near_limit, t, y_.data(), dy_.data());
  look.theta = theta;
  look.watch = dynamics.watch();
  look.rate = dynamics.watch_rate();
  for (double& rate : look.rate) rate *= integrator.h();
}

// Takes the stored sample at the start or end of the step.
void EventFinder::look_at_end(const Integrator& integrator, bool is_last, Look& look) {
  look.theta = is_last ? 1.0 : 0.0;
  look.watch = is_last ? integrator.watch1() : integrator.watch0();
  look.rate = is_last ? integrator.watch_rate1() : integrator.watch_rate0();
  for (double& rate : look.rate) rate *= integrator.h();
}

// Returns true if the slot belongs to a joint inside a cluster; these are not evaluated at every stage.
bool EventFinder::is_merged(const Dynamics& dynamics, int slot) {
  if (!are_merged_known_) {
    std::fill(merged_.begin(), merged_.end(), 0);
    for (const int f : dynamics.layout().merged) std::fill_n(merged_.begin() + system_.frictions[f].watch, k_friction_watches, 1);
    are_merged_known_ = true;
  }
  return merged_[slot] != 0;
}

EventFinder::Suspicion EventFinder::suspicion(Integrator& integrator, const Dynamics& dynamics, const std::vector<char>& fresh) {
  near_.clear();
  are_merged_known_ = false;
  WatchNodes& nodes = integrator.watch_nodes();
  nodes.close(integrator.watch0().data(), integrator.watch1().data());
  Suspicion worst = Suspicion::none;
  const double h = integrator.h();
  for (int i = 0; i < slots_; ++i) {
    const double low = nodes.low(i);
    if (2.0 * low > nodes.high(i)) continue; // far
    const double w0 = integrator.watch0()[i], w1 = integrator.watch1()[i];
    const double start = fresh[i] ? std::max(w0, 0.0) : w0;
    const WatchedStep watched{
        i, is_merged(dynamics, i), is_of_joint_[i] != 0, {start, h * integrator.watch_rate0()[i]}, {w1, h * integrator.watch_rate1()[i]}};
    if (w1 < 0.0) {
      // A simple sign change. A function that is fresh, or negative at the start (rounding, or the projection at another event), must be
      // surveyed.
      const bool is_plain = !fresh[i] && w0 >= 0.0 && nodes.crosses_once(watched);
      worst = std::max(worst, is_plain ? Suspicion::at_end : Suspicion::inside);
      if (!is_plain) near_.push_back(i);
      continue;
    }
    if (nodes.is_surely_positive(watched)) continue;
    near_.push_back(i);
    worst = Suspicion::inside;
  }
  return worst;
}

// Puts armed slots that are ≥ 0 in `low` and negative in `high` into fired_.
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
  for (const int slot : rate_slots_) slack_[slot] = slack + k_off_joints * integrator.max_velocity_residual();
  if (place_slots_.empty()) return;
  const double place_slack = integrator.place_accuracy(dynamics) + k_off_joints * integrator.max_position_residual();
  for (const int slot : place_slots_) slack_[slot] = place_slack;
}

// Returns true if a joint inside a cluster may slip in this step. If not, such joints need no evaluation in it.
bool EventFinder::is_any_merged_near(const Integrator& integrator, const Dynamics& dynamics) const {
  const std::vector<int>& merged = dynamics.layout().merged;
  return std::any_of(merged.begin(), merged.end(), [&](int f) {
    const int first = system_.frictions[f].watch;
    const auto is_of_joint = [first](int slot) { return slot >= first && slot < first + k_friction_watches; };
    return integrator.watch1()[first] < 0.0 || integrator.watch1()[first + 1] < 0.0 || std::any_of(near_.begin(), near_.end(), is_of_joint);
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
  const Suspicion suspected = suspicion(integrator, dynamics, fresh);
  if (suspected == Suspicion::none) return false;
  is_step_withdrawn_ = !integrator.bears_look(dynamics);
  if (is_step_withdrawn_) return false;
  set_slack(integrator, dynamics);
  is_merged_near_ = is_any_merged_near(integrator, dynamics);
  Bracket bracket = suspected == Suspicion::inside ? survey(integrator, dynamics, fresh) : bracket_whole(integrator);
  if (bracket == Bracket::none) return false;
  // A function between −slack_ and zero at the start of the bracket that does not recover has passed zero before; the event is there. A
  // function that was negative at the start of the step ends its mode at once.
  const auto has_passed = [&](int slot) {
    return armed_[slot] != 0 && fresh[slot] == 0 && integrator.watch0()[slot] >= 0.0 && low_.watch[slot] < 0.0;
  };
  if (bracket == Bracket::at_once && std::any_of(fired_.begin(), fired_.end(), has_passed)) {
    std::erase_if(fired_, [&](int slot) { return !has_passed(slot); });
    std::swap(low_, high_);
    look_at_end(integrator, false, low_);
    bracket = Bracket::found;
  }
  if (bracket == Bracket::found) close_in(integrator, dynamics);
  theta_ = high_.theta;
  integrator.cut_at(dynamics, theta_);
  integrator.dense(dynamics, theta_, y_.data());
  return true;
}

} // namespace steplap
