#include "mbd/simulation/leg_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace steplap {

namespace {

// Smallest displacement, in rounding errors of a coordinate, that counts as motion, however small the body.
constexpr double k_roundings = 64.0;
constexpr long k_quiet_states = 16; // after this many consecutive recorded states without a new direction the interval is doubled
constexpr long k_most_stride = 32;  // largest number of steps between recorded states
constexpr std::size_t k_most_states = 16;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

} // namespace

MotionSpan::MotionSpan(const System& system, const State& begin)
    : begin_(begin.q.begin() + 3, begin.q.end()), weights_(begin_.size()), least_(begin_.size()), displacement_(begin_.size()) {
  for (std::size_t body = 1; body < system.bodies.size(); ++body) {
    const BodyData& b = system.bodies[body];
    const double mass = std::sqrt(std::max(b.mass, 0.0)), inertia = std::sqrt(std::max(b.inertia, 0.0));
    const double radius = mass > 0.0 ? inertia / mass : 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = 3 * body - 3 + k;
      weights_[i] = k < 2 ? mass : inertia;
      const double rounding = k_roundings * std::numeric_limits<double>::epsilon() * std::abs(begin_[i]);
      least_[i] = weights_[i] * std::max(k_moved * (k < 2 ? radius : 1.0), rounding);
    }
  }
}

void MotionSpan::remove(std::vector<double>& displacement) const {
  for (int pass = 0; pass < 2; ++pass) // the second pass removes rounding errors of the first
    for (const std::vector<double>& direction : directions_) {
      const double share = dot(direction, displacement);
      for (std::size_t i = 0; i < displacement.size(); ++i) displacement[i] -= share * direction[i];
    }
}

MotionSpan MotionSpan::before(double t) const {
  MotionSpan part = *this;
  const auto count = std::lower_bound(since_.begin(), since_.end(), t) - since_.begin();
  part.since_.resize(static_cast<std::size_t>(count));
  part.directions_.resize(static_cast<std::size_t>(count));
  return part;
}

bool MotionSpan::add(double t, const std::vector<double>& q) {
  if (directions_.size() >= begin_.size()) return false;
  bool is_moved = false;
  for (std::size_t i = 0; i < begin_.size(); ++i) {
    displacement_[i] = weights_[i] * (q[i + 3] - begin_[i]);
    is_moved = is_moved || std::abs(displacement_[i]) > least_[i];
  }
  if (!is_moved) return false; // small in every coordinate, therefore also outside the span
  const double whole = std::sqrt(dot(displacement_, displacement_));
  remove(displacement_);
  double beyond = 0.0;
  for (std::size_t i = 0; i < begin_.size(); ++i)
    if (least_[i] > 0.0) beyond = std::max(beyond, std::abs(displacement_[i]) / least_[i]);
  const double length = std::sqrt(dot(displacement_, displacement_));
  constexpr double k_cancelled = 1e-12; // components below this fraction of the displacement are rounding errors of the projections
  if (!(beyond > 1.0) || !(length > k_cancelled * whole)) return false;
  for (double& part : displacement_) part /= length;
  directions_.push_back(displacement_);
  since_.push_back(t);
  return true;
}

void MotionNotes::begin_leg(std::shared_ptr<const System> system, const System& of_leg, std::size_t past_legs, State begin) {
  MotionSpan span(of_leg, begin);
  scratch_ = begin;
  const double t = begin.t;
  legs_.push_back({std::move(system), past_legs, std::move(begin), t, {}, std::move(span)});
  steps_ = recorded_states_ = quiet_ = 0;
  next_ = stride_ = keep_stride_ = 1;
}

void MotionNotes::note(const State& state) {
  LegMotion& leg = legs_.back();
  leg.end = state.t;
  if (leg.moved.add(state.t, state.q)) {
    quiet_ = 0;
    stride_ = 1;
  } else if (++quiet_ >= k_quiet_states && stride_ < k_most_stride) {
    quiet_ = 0;
    stride_ *= 2;
  }
  next_ = steps_ + stride_;
  if (recorded_states_++ % keep_stride_ != 0) return;
  leg.states.push_back(state);
  if (leg.states.size() < k_most_states) return;
  for (std::size_t i = 0; 2 * i < leg.states.size(); ++i) std::swap(leg.states[i], leg.states[2 * i]);
  leg.states.resize(k_most_states / 2);
  keep_stride_ *= 2;
}

} // namespace steplap
