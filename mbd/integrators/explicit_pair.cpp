#include "mbd/integrators/explicit_pair.h"

#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/integrators/scene_rate.h"

#include <limits>

namespace steplap {

namespace {

constexpr double k_shortest_retry = 0.1;
constexpr double k_shorter = 0.2; // factor for the length after a step with an infinite error
// Near a singular position rounding prevents agreement of stages only for tolerances below this.
constexpr double k_near_rounding = 1e-10;
// Fraction of the distance to the singular position at which the next attempt begins after a failure.
constexpr double k_closer = 0.5;

} // namespace

ExplicitPair::ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension, int stages, int order)
    : Integrator(dynamics, settings, max_dimension), k_(static_cast<std::size_t>(stages) * max_dimension, 0.0), stride_(max_dimension),
      order_(order), next_h_(settings.step) {
  control_.order = order;
}

// The step length is kept across an event: it was limited by the motion, which usually changes little.
void ExplicitPair::on_restart(Dynamics&) {
  control_.previous_error = 1e-4;
  approach_.restart();
}

double ExplicitPair::shorter(double error) const {
  if (!std::isfinite(error)) return k_shorter;
  return std::clamp(0.9 * portable::pow(error, -1.0 / order_), k_shortest_retry, 0.9);
}

void ExplicitPair::note_end(double pivot) {
  ++steps_;
  saved_control_.approach = approach_;
  approach_.note_end(pivot);
}

// Near a singular position most of the difference between stages is constraint violation, which projection removes, so the dense output is
// not checked.
double ExplicitPair::error_inside(Dynamics& dynamics) {
  is_inside_known_ = true;
  return is_beside_singular_ ? 0.0 : dense_error(dynamics);
}

void ExplicitPair::refuse_shorter_than_rounding(double h) const {
  if (h < 16.0 * std::numeric_limits<double>::epsilon() * rounding_time_scale(t0_, system_))
    throw NumericalFailure("step size fell to " + rounded_text(h, 3) + " s at t = " + rounded_text(t0_, 12) +
                           " s: the motion becomes singular there, or the tolerance is too small");
}

bool ExplicitPair::dense_output_is_accurate(Dynamics& dynamics) {
  if (is_crossing_ || is_inside_known_) return true;
  const double inside = error_inside(dynamics);
  return inside <= 1.0 || !withdraw(dynamics, h_ * shorter(inside));
}

bool ExplicitPair::withdraw(Dynamics& dynamics, double h) {
  if (is_crossing_) return false;
  --steps_;
  ++rejections_;
  approach_ = saved_control_.approach;
  control_.previous_error = saved_control_.error;
  next_h_ = h;
  refuse_shorter_than_rounding(next_h_);
  dynamics.rates(t0_, y0_.data(), scratch_.data()); // the next try starts there
  return true;
}

void ExplicitPair::dense(Dynamics& dynamics, double theta, double* out) {
  if (is_crossing_) crossing_->dense(theta, crossing_step(dynamics), out);
  else dense_of_pair(dynamics, theta, out);
}

// After a try that came near a singular position: crosses it by one step of collocation with the position in its middle. Returns 0 if this
// succeeded, otherwise the length of the next try.
double ExplicitPair::cross_singularity(Dynamics& dynamics, double left) {
  if (!crossing_) crossing_ = std::make_unique<SingularCrossing>(stride_);
  const double h_tried = h_;
  const double ahead = h_ * crossing_->locate(dynamics, crossing_step(dynamics));
  const double h = ahead > 0.0 ? crossing_->length_with_gap_at(ahead, left) : 0.0;
  if (h == 0.0) return h_tried;
  h_ = h;
  t1_ = t0_ + h_;
  begin_event_nodes();
  const double error = crossing_->cross(dynamics, crossing_step(dynamics), y1_.data());
  is_crossing_ = error <= 1.0;
  const bool has_choice = dynamics.coordinates() == Coordinates::automatic && dynamics.layout().has_mechanisms();
  if (has_choice && error == std::numeric_limits<double>::infinity() && settings_.tolerance < k_near_rounding)
    throw JointsNearSingular("a singular position of the joints behind t = " + rounded_text(t0_, 12) + " s is not passed");
  return is_crossing_ ? 0.0 : std::min(h_tried, k_closer * ahead);
}

void ExplicitPair::begin_step(Dynamics& dynamics, double t_limit) {
  Integrator::begin_step(dynamics, t_limit);
  attempt_.left = t_limit - t0_;
  const double h_max = limited_by_turns(dynamics, limited(attempt_.left), settings_.division);
  if (next_h_ <= 0.0) next_h_ = first_step(dynamics, order_ - 1, h_max);
  update_weights(dynamics);
  attempt_.h = std::min(next_h_, h_max);
  attempt_.passage.emplace(dynamics);
  if (is_restarted_) attempt_.h = restrained_step(dynamics, attempt_.h);
  attempt_.is_retry = attempt_.has_tried_crossing = false;
  prepare_try();
}

void ExplicitPair::prepare_try() {
  const double h = attempt_.h, left = attempt_.left;
  attempt_.is_last = h >= left * (1.0 - 1e-10);
  // Two equal steps instead of a long one followed by a tiny one.
  h_ = attempt_.is_last ? left : (2.0 * h > left ? 0.5 * left : h);
  t1_ = attempt_.is_last ? t_limit_ : t0_ + h_;
  begin_event_nodes();
  attempt_.passage->begin_try();
  is_crossing_ = is_inside_known_ = false;
}

bool ExplicitPair::accept_inside(Dynamics& dynamics, double& inside) {
  const double pivot = dynamics.smallest_pivot();
  is_beside_singular_ = approach_.is_beside(dynamics.least_pivot());
  if (are_dense_evaluations_expected()) inside = error_inside(dynamics);
  if (inside > 1.0) return false;
  saved_control_.error = control_.previous_error;
  const double factor = control_.factor(std::max(try_error_, inside), attempt_.is_retry);
  // If the limit has cut the step, the next one may still have the planned length.
  next_h_ = h_ < attempt_.h ? std::max(attempt_.h, h_ * factor) : h_ * factor;
  note_end(pivot);
  return true;
}

bool ExplicitPair::conclude_try(Dynamics& dynamics) {
  if (!attempt_.has_tried_crossing && approach_.is_ahead(dynamics.least_pivot())) [[unlikely]] {
    attempt_.has_tried_crossing = true;
    const double h_next = cross_singularity(dynamics, attempt_.left);
    if (h_next == 0.0 && try_finish_step(dynamics)) {
      note_end(dynamics.smallest_pivot());
      return true;
    }
    return try_again(h_next == 0.0 ? k_shorter * h_ : h_next);
  }
  if (try_error_ <= 1.0 && !attempt_.is_last && attempt_.passage->wants_other_end()) {
    ++rejections_;
    return try_again(SingularPassage::k_shorter_end * h_);
  }
  double inside = 0.0;
  if (try_error_ <= 1.0) {
    if (!try_finish_step(dynamics)) {
      ++rejections_;
      return try_again(k_shorter * h_);
    }
    if (accept_inside(dynamics, inside)) return true;
  }
  ++rejections_;
  if (inside <= 1.0 && attempt_.passage->wants_other_stages()) return try_again(SingularPassage::k_shorter_across * h_);
  const double h = h_ * shorter(std::max(try_error_, inside));
  refuse_shorter_than_rounding(h);
  return try_again(h);
}

} // namespace steplap
