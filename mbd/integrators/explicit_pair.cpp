#include "mbd/integrators/explicit_pair.h"

#include "mbd/base/shown_text.h"
#include "mbd/integrators/singular_passage.h"
#include "mbd/math/portable_math.h"

#include <limits>

namespace steplap {

namespace {

constexpr double k_shortest_retry = 0.1;
constexpr double k_shorter = 0.2; // after a step that came to nothing
// A step with a stage nearer than this (a square, rad²) to a singular position is made by collocation.
constexpr double k_crossed_pivot = 2e-2;
// Unless it begins so near that it would have to be tiny.
constexpr double k_closest_start = 4e-4;
// Rounding beside a singular position keeps stages from agreeing to tolerances below this one only.
constexpr double k_near_rounding = 1e-10;
// Of the way to the position: where the next attempt begins if one fails.
constexpr double k_closer = 0.5;

} // namespace

ExplicitPair::ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings,
                           int max_dimension, int stages, int order)
    : Integrator(dynamics, settings, max_dimension),
      k_(static_cast<std::size_t>(stages) * max_dimension, 0.0), stride_(max_dimension),
      order_(order), next_h_(settings.step) {
  control_.order = order;
}

// The step size survives an event: what limited it was the motion, which goes on much the same.
void ExplicitPair::on_restart(Dynamics&) {
  control_.previous_error = 1e-4;
  start_pivot_ = highest_pivot_ = 1.0;
}

double ExplicitPair::shorter(double error) const {
  if (!std::isfinite(error)) return k_shorter;
  return std::clamp(0.9 * portable::pow(error, -1.0 / order_), k_shortest_retry, 0.9);
}

void ExplicitPair::note_end(double pivot) {
  ++steps_;
  before_.start_pivot = start_pivot_;
  before_.highest_pivot = highest_pivot_;
  // The first step's end tells what is usual here.
  const bool is_first = highest_pivot_ == 1.0;
  start_pivot_ = pivot;
  highest_pivot_ = is_first ? start_pivot_ : std::max(highest_pivot_, start_pivot_);
}

SingularCrossing::Step ExplicitPair::crossing_step(Dynamics& dynamics) {
  SingularCrossing::Step step;
  step.t0 = t0_;
  step.h = h_;
  step.y0 = y0_.data();
  step.rate0 = k0_;
  step.n = n_;
  step.norm = [this](const double* error) { return error_norm(error); };
  step.note_stage = [this, &dynamics](const double* rates, double theta) { note_stage_watches(dynamics, rates, theta); };
  return step;
}

// Beside a singular position of joints what projection takes away is no error, and most of what stages differ by.
double ExplicitPair::error_inside(Dynamics& dynamics) {
  is_inside_known_ = true;
  return is_beside_singular_ ? 0.0 : dense_error(dynamics);
}

void ExplicitPair::refuse_shorter_than_rounding(double h) const {
  if (h < 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t0_), 1e-3))
    throw NumericalFailure("step size fell to " + rounded_text(h, 3) + " s at t = " + rounded_text(t0_, 12) +
                           " s: the motion becomes singular there, or the tolerance is too small");
}

bool ExplicitPair::bears_look(Dynamics& dynamics) {
  if (is_crossing_ || is_inside_known_) return true;
  const double inside = error_inside(dynamics);
  if (inside <= 1.0) return true;
  --steps_;
  ++rejections_;
  start_pivot_ = before_.start_pivot;
  highest_pivot_ = before_.highest_pivot;
  control_.previous_error = before_.error;
  next_h_ = h_ * shorter(inside);
  refuse_shorter_than_rounding(next_h_);
  dynamics.rates(t0_, y0_.data(), scratch_.data()); // where the next try begins
  return false;
}

void ExplicitPair::dense(Dynamics& dynamics, double theta, double* out) {
  if (is_crossing_) crossing_->dense(theta, crossing_step(dynamics), out);
  else dense_of_pair(dynamics, theta, out);
}

// Falling towards a singular position, not merely small all the time?
bool ExplicitPair::comes_near_singularity(const Dynamics& dynamics) const {
  const double lowest = dynamics.lowest_pivot();
  return lowest < k_crossed_pivot && lowest < start_pivot_ && lowest < 0.5 * highest_pivot_ &&
         start_pivot_ > k_closest_start;
}

// After a try that came near a singular position: the same way in one step of another kind, the position in
// its middle. 0 if that step was made, else how long the next try should be.
double ExplicitPair::cross_singularity(Dynamics& dynamics, double left) {
  if (!crossing_) crossing_ = std::make_unique<SingularCrossing>(stride_);
  const double h_tried = h_;
  const double ahead = h_ * crossing_->locate(dynamics, crossing_step(dynamics));
  const double h = ahead > 0.0 ? crossing_->length_with_gap_at(ahead, left) : 0.0;
  if (h == 0.0) return h_tried;
  h_ = h;
  t1_ = t0_ + h_;
  begin_watch_nodes();
  const double error = crossing_->cross(dynamics, crossing_step(dynamics), y1_.data());
  is_crossing_ = error <= 1.0;
  const bool has_choice = dynamics.coordinates() == Coordinates::automatic && dynamics.layout().has_mechanisms();
  if (has_choice && error == std::numeric_limits<double>::infinity() && settings_.tolerance < k_near_rounding)
    throw JointsNearSingular("a singular position of the joints behind t = " + rounded_text(t0_, 12) +
                             " s is not passed");
  return is_crossing_ ? 0.0 : std::min(h_tried, k_closer * ahead);
}

void ExplicitPair::step(Dynamics& dynamics, double t_limit) {
  const double left = t_limit - t0_;
  const double h_max = limited(left);
  if (next_h_ <= 0.0) next_h_ = first_step(dynamics, order_ - 1, h_max);
  update_weights(dynamics);
  double h = std::min(next_h_, h_max);
  SingularPassage passage(dynamics);
  if (is_restarted_) h = restrained_step(dynamics, h);
  bool has_tried_crossing = false;
  for (bool is_retry = false;; is_retry = true) {
    const bool is_last = h >= left * (1.0 - 1e-10);
    // Two even steps rather than a long one and a sliver.
    h_ = is_last ? left : (2.0 * h > left ? 0.5 * left : h);
    t1_ = is_last ? t_limit : t0_ + h_;
    begin_watch_nodes();
    passage.begin_try();
    is_crossing_ = is_inside_known_ = false;
    const double error = try_step(dynamics);
    if (!has_tried_crossing && comes_near_singularity(dynamics)) [[unlikely]] {
      has_tried_crossing = true;
      const double h_next = cross_singularity(dynamics, left);
      if (h_next == 0.0 && try_finish_step(dynamics)) {
        note_end(dynamics.smallest_pivot());
        return;
      }
      h = h_next == 0.0 ? k_shorter * h_ : h_next;
      continue;
    }
    if (error <= 1.0 && !is_last && passage.wants_other_end()) {
      ++rejections_;
      h = SingularPassage::k_shorter_end * h_;
      continue;
    }
    double inside = 0.0;
    if (error <= 1.0) {
      if (!try_finish_step(dynamics)) {
        ++rejections_;
        h = k_shorter * h_;
        continue;
      }
      const double pivot = dynamics.smallest_pivot();
      const double lowest = dynamics.lowest_pivot();
      is_beside_singular_ = lowest < k_crossed_pivot && lowest < 0.5 * highest_pivot_;
      if (are_looks_expected()) inside = error_inside(dynamics);
      if (inside <= 1.0) {
        before_.error = control_.previous_error;
        const double factor = control_.factor(std::max(error, inside), is_retry);
        // A step cut short by the limit says nothing against the longer one that was planned.
        next_h_ = h_ < h ? std::max(h, h_ * factor) : h_ * factor;
        note_end(pivot);
        return;
      }
    }
    ++rejections_;
    if (inside <= 1.0 && passage.wants_other_stages()) {
      h = SingularPassage::k_shorter_across * h_;
      continue;
    }
    h = h_ * shorter(std::max(error, inside));
    refuse_shorter_than_rounding(h);
  }
}

} // namespace steplap
