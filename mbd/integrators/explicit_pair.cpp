#include "mbd/integrators/explicit_pair.h"

#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"

#include <limits>

namespace steplap {

namespace {

constexpr double k_shortest_retry = 0.1;
constexpr double k_shorter = 0.2; // factor on the step length after an attempt with an infinite error
// Only below this tolerance does rounding prevent the stages near a singular position from converging.
constexpr double k_near_rounding = 1e-10;
// Fraction of the distance to the singular position at which the next attempt begins after a failure.
constexpr double k_closer = 0.5;

} // namespace

ExplicitPair::ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension, int stages, int order)
    : Integrator(dynamics, settings, max_dimension), k_(static_cast<std::size_t>(stages) * max_dimension, 0.0), stride_(max_dimension),
      order_(order), next_h_(settings.step) {
  control_.order = order;
}

// The step length is kept across an event: the motion limited it, and usually changes little.
void ExplicitPair::on_restart(Dynamics&) {
  control_.previous_error = 1e-4;
  approach_.restart();
}

double ExplicitPair::shrink_factor(double error) const {
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

bool ExplicitPair::dense_output_is_accurate(Dynamics& dynamics) {
  if (is_crossing_ || is_inside_known_) return true;
  const double inside = error_inside(dynamics);
  return inside <= 1.0 || !withdraw(dynamics, h_ * shrink_factor(inside));
}

bool ExplicitPair::withdraw(Dynamics& dynamics, double h) {
  if (is_crossing_) return false;
  --steps_;
  ++rejections_;
  approach_ = saved_control_.approach;
  control_.previous_error = saved_control_.error;
  next_h_ = h;
  refuse_shorter_than_rounding(next_h_);
  dynamics.rates(t0_, y0_.data(), scratch_.data()); // leaves `dynamics` evaluated at the start of the next attempt
  return true;
}

void ExplicitPair::dense(Dynamics& dynamics, double theta, double* out) {
  if (is_crossing_) crossing_->dense(theta, crossing_step(dynamics), out);
  else dense_of_pair(dynamics, theta, out);
}

// After an attempt that came near a singular position: crosses that position by one collocation step with the position in its middle.
// Returns 0 if this succeeded, otherwise the length of the next attempt, s.
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
  if (!is_crossing_) return std::min(h_tried, k_closer * ahead);
  if (!try_finish_step(dynamics)) return k_shorter * h_;
  note_end(dynamics.smallest_pivot());
  return 0.0;
}

// Begins an attempt of about the length h, adjusted to the limit. Returns true if the attempt ends at the limit.
bool ExplicitPair::begin_try(double h, double t_limit) {
  const double left = t_limit - t0_;
  const bool is_last = h >= left * (1.0 - 1e-10);
  // Two equal steps are made instead of a long one followed by a tiny one.
  h_ = is_last ? left : (2.0 * h > left ? 0.5 * left : h);
  t1_ = is_last ? t_limit : t0_ + h_;
  begin_event_nodes();
  is_crossing_ = is_inside_known_ = false;
  return is_last;
}

// Completes a step whose end is accurate, and chooses the length of the next one, provided that the dense output is accurate enough.
// `inside` receives the error norm of the dense output if that norm is computed.
bool ExplicitPair::accept_inside(Dynamics& dynamics, double h, double error, bool is_retry, double& inside) {
  const double pivot = dynamics.smallest_pivot();
  is_beside_singular_ = approach_.is_beside(dynamics.least_pivot());
  if (are_dense_evaluations_expected()) inside = error_inside(dynamics);
  if (inside > 1.0) return false;
  saved_control_.error = control_.previous_error;
  const double factor = control_.factor(std::max(error, inside), is_retry);
  // If the limit has cut the step, the next one may still have the planned length.
  next_h_ = h_ < h ? std::max(h, h_ * factor) : h_ * factor;
  note_end(pivot);
  return true;
}

void ExplicitPair::step(Dynamics& dynamics, double t_limit) {
  const double left = t_limit - t0_;
  const double h_max = limited_by_turns(dynamics, limited(left), settings_.division);
  if (next_h_ <= 0.0) next_h_ = first_step(dynamics, order_ - 1, h_max);
  update_weights(dynamics);
  double h = std::min(next_h_, h_max);
  SingularPassage passage(dynamics);
  if (is_restarted_) h = restrained_step(dynamics, h);
  bool has_tried_crossing = false;
  for (bool is_retry = false;; is_retry = true) {
    const bool is_last = begin_try(h, t_limit);
    passage.begin_try();
    double error = std::numeric_limits<double>::infinity();
    (void)try_evaluation(h_, [&] { error = try_step(dynamics); });
    if (!has_tried_crossing && approach_.is_ahead(dynamics.least_pivot())) [[unlikely]] {
      has_tried_crossing = true;
      h = cross_singularity(dynamics, left);
      if (h == 0.0) return;
      continue;
    }
    const bool is_end_accurate = error <= 1.0;
    double inside = 0.0;
    if (is_end_accurate && !is_last && passage.needs_other_end()) h = rejected(SingularPassage::k_shorter_end);
    else if (is_end_accurate && !try_finish_step(dynamics)) h = rejected(k_shorter);
    else if (is_end_accurate && accept_inside(dynamics, h, error, is_retry, inside)) return;
    else if (inside <= 1.0 && passage.needs_other_stages()) h = rejected(SingularPassage::k_shorter_across);
    else h = rejected(shrink_factor(std::max(error, inside)));
    refuse_shorter_than_rounding(h); // for every reason: an end that no projection reaches would shorten the step for ever
  }
}

} // namespace steplap
