#include "mbd/events/event_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

constexpr int k_usual_intervals = 128; // capacity for intervals that a survey reserves in advance
// Error of joints in dense output, relative to the constraint residual at the end of the step before projection. The factor covers
// measurements with longer levers.
constexpr double k_off_joints = 10.0;

} // namespace

EventFinder::EventFinder(const System& system, int max_dimension)
    : system_(system), slots_(system.event_count), y_(max_dimension, 0.0), dy_(max_dimension, 0.0), armed_(slots_, 1),
      armed_before_(slots_, 1) {
  tolerance_.assign(slots_, 0.0);
  surveyed_slots_.reserve(slots_);
  interpolants_.reserve(slots_);
  merged_.assign(slots_, 0);
  fired_.reserve(slots_);
  fired_before_.reserve(slots_);
  intervals_.reserve(k_usual_intervals);
  for (const Unit& unit : system.units)
    for (int w = 0; w < unit.event_count; ++w) {
      const EventTolerance kind = unit.group->event_tolerance(w);
      if (kind != EventTolerance::none) (kind == EventTolerance::position ? place_slots_ : rate_slots_).push_back(unit.first_event + w);
    }
  is_of_joint_.assign(slots_, 0);
  for (const FrictionUnit& unit : system.frictions)
    if (unit.friction->dimension() == 3) std::fill_n(is_of_joint_.begin() + unit.first_event, k_friction_event_count, 1);
  for (Sample& sample : nodes_) sample.event_value.resize(slots_), sample.rate.resize(slots_);
}

void EventFinder::sample_at(Integrator& integrator, Dynamics& dynamics, double theta, Sample& sample) {
  integrator.dense(dynamics, theta, y_.data());
  const double t = integrator.t0() + theta * integrator.h();
  dynamics.evaluate(is_merged_near_ ? Request::stage_and_joints : Request::stage_near_limit, t, y_.data(), dy_.data());
  sample.theta = theta;
  sample.event_value = dynamics.event_value();
  sample.rate = dynamics.event_derivative();
  for (double& rate : sample.rate) rate *= integrator.h();
}

// Takes the stored sample at the start or end of the step.
void EventFinder::stored_sample(const Integrator& integrator, bool is_last, Sample& sample) {
  sample.theta = is_last ? 1.0 : 0.0;
  sample.event_value = is_last ? integrator.event_value1() : integrator.event_value0();
  sample.rate = is_last ? integrator.event_derivative1() : integrator.event_derivative0();
  for (double& rate : sample.rate) rate *= integrator.h();
}

// Returns true if the slot belongs to a joint inside a cluster. Such joints are not evaluated at every stage.
bool EventFinder::is_merged(const Dynamics& dynamics, int slot) {
  if (!are_merged_known_) {
    std::fill(merged_.begin(), merged_.end(), 0);
    for (const int f : dynamics.layout().merged) std::fill_n(merged_.begin() + system_.frictions[f].first_event, k_friction_event_count, 1);
    are_merged_known_ = true;
  }
  return merged_[slot] != 0;
}

EventFinder::Screening EventFinder::screen(Integrator& integrator, const Dynamics& dynamics, const std::vector<char>& fresh) {
  surveyed_slots_.clear();
  are_merged_known_ = false;
  EventNodes& nodes = integrator.event_nodes();
  nodes.close(integrator.event_value0().data(), integrator.event_value1().data());
  Screening worst = Screening::none;
  const double h = integrator.h();
  for (int i = 0; i < slots_; ++i) {
    const double low = nodes.low(i);
    if (2.0 * low > nodes.high(i)) continue; // test 1 of event_finder.h: far from zero
    const double w0 = integrator.event_value0()[i], w1 = integrator.event_value1()[i];
    const double start = fresh[i] ? std::max(w0, 0.0) : w0;
    const EventStep watched{i,
                            is_merged(dynamics, i),
                            is_of_joint_[i] != 0,
                            {start, h * integrator.event_derivative0()[i]},
                            {w1, h * integrator.event_derivative1()[i]}};
    if (w1 < 0.0) {
      // A simple sign change needs no survey. A survey is necessary if the function is fresh, or negative at the start (by rounding, or by
      // the projection at another event).
      const bool is_plain = !fresh[i] && w0 >= 0.0 && nodes.crosses_once(watched);
      worst = std::max(worst, is_plain ? Screening::at_end : Screening::inside);
      if (!is_plain) surveyed_slots_.push_back(i);
      continue;
    }
    if (nodes.is_proven_positive(watched)) continue;
    surveyed_slots_.push_back(i);
    worst = Screening::inside;
  }
  return worst;
}

// Stores in fired_ the armed slots that are ≥ 0 in `low` and negative in `high`.
bool EventFinder::find_sign_changes(const Sample& low, const Sample& high) {
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (armed_[i] && high.event_value[i] < 0.0 && low.event_value[i] >= 0.0) fired_.push_back(i);
  return !fired_.empty();
}

bool EventFinder::find_sign_changes_beyond_tolerance(const Sample& low, const Sample& high) {
  fired_.clear();
  for (int i = 0; i < slots_; ++i)
    if (armed_[i] && high.event_value[i] < (high.theta < 1.0 ? -tolerance_[i] : 0.0) && low.event_value[i] >= -tolerance_[i])
      fired_.push_back(i);
  return !fired_.empty();
}

void EventFinder::set_tolerance(const Integrator& integrator, const Dynamics& dynamics) {
  const double slack = integrator.rate_accuracy(dynamics);
  for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
    const FrictionUnit& unit = system_.frictions[f];
    const bool is_rate = unit.friction->dimension() == 1 && dynamics.state().friction[f].phase == FrictionPhase::slip;
    tolerance_[unit.slot(FrictionWatch::first)] = is_rate ? slack : 0.0;
  }
  for (const int slot : rate_slots_) tolerance_[slot] = slack + k_off_joints * integrator.max_velocity_residual();
  if (place_slots_.empty()) return;
  const double place_slack = integrator.place_accuracy(dynamics) + k_off_joints * integrator.max_position_residual();
  for (const int slot : place_slots_) tolerance_[slot] = place_slack;
}

// Returns true if a joint inside a cluster may slip in this step. If not, such joints need no evaluation in it.
bool EventFinder::is_any_merged_near(const Integrator& integrator, const Dynamics& dynamics) const {
  const std::vector<int>& merged = dynamics.layout().merged;
  return std::any_of(merged.begin(), merged.end(), [&](int f) {
    const int first = system_.frictions[f].slot(FrictionWatch::first), second = system_.frictions[f].slot(FrictionWatch::second);
    const auto is_of_joint = [first](int slot) { return slot >= first && slot < first + k_friction_event_count; };
    return integrator.event_value1()[first] < 0.0 || integrator.event_value1()[second] < 0.0 ||
           std::any_of(surveyed_slots_.begin(), surveyed_slots_.end(), is_of_joint);
  });
}

EventFinder::Bracket EventFinder::bracket_whole(const Integrator& integrator) {
  stored_sample(integrator, false, low_);
  stored_sample(integrator, true, high_);
  std::fill(armed_.begin(), armed_.end(), 1);
  return find_sign_changes(low_, high_) ? Bracket::found : Bracket::none;
}

bool EventFinder::find(Integrator& integrator, Dynamics& dynamics, const std::vector<char>& fresh) {
  is_step_withdrawn_ = false;
  if (slots_ == 0) return false;
  const Screening suspected = screen(integrator, dynamics, fresh);
  if (suspected == Screening::none) return false;
  is_step_withdrawn_ = !integrator.dense_output_is_accurate(dynamics);
  if (is_step_withdrawn_) return false;
  set_tolerance(integrator, dynamics);
  is_merged_near_ = is_any_merged_near(integrator, dynamics);
  Bracket bracket = suspected == Screening::inside ? survey(integrator, dynamics, fresh) : bracket_whole(integrator);
  if (bracket == Bracket::none) return false;
  // A function between −tolerance_ and zero at the start of the bracket, which does not become positive again, has passed zero before; the
  // event is at that start. A function that was negative at the start of the step ends its mode at once.
  const auto has_passed = [&](int slot) {
    return armed_[slot] != 0 && fresh[slot] == 0 && integrator.event_value0()[slot] >= 0.0 && low_.event_value[slot] < 0.0;
  };
  if (bracket == Bracket::immediate && std::any_of(fired_.begin(), fired_.end(), has_passed)) {
    std::erase_if(fired_, [&](int slot) { return !has_passed(slot); });
    std::swap(low_, high_);
    stored_sample(integrator, false, low_);
    bracket = Bracket::found;
  }
  if (bracket == Bracket::found) locate_root(integrator, dynamics);
  theta_ = high_.theta;
  integrator.cut_at(dynamics, theta_);
  integrator.dense(dynamics, theta_, y_.data());
  return true;
}

} // namespace steplap
