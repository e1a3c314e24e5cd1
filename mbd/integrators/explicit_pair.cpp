#include "mbd/integrators/explicit_pair.h"

#include "mbd/integrators/singular_passage.h"

#include <limits>

namespace steplap {

namespace {

constexpr double k_shortest_retry = 0.1;

} // namespace

ExplicitPair::ExplicitPair(const Dynamics& dynamics, const IntegratorSettings& settings,
                           int max_dimension, int stages, int order)
    : Integrator(dynamics, settings, max_dimension),
      k_(static_cast<std::size_t>(stages) * max_dimension, 0.0), stride_(max_dimension),
      order_(order), next_h_(settings.step) {
  control_.order = order;
}

// The step size survives an event: what limited it was the motion, which goes on much the same.
void ExplicitPair::on_restart(Dynamics&) { control_.previous_error = 1e-4; }

void ExplicitPair::step(Dynamics& dynamics, double t_limit) {
  const double left = t_limit - t0_;
  const double h_max = settings_.max_step > 0.0 ? settings_.max_step : left;
  if (next_h_ <= 0.0) next_h_ = first_step(dynamics, order_ - 1, std::min(left, h_max));
  update_weights(dynamics);
  double h = std::min(next_h_, h_max);
  SingularPassage passage(dynamics);
  for (bool is_retry = false;; is_retry = true) {
    const bool is_last = h >= left * (1.0 - 1e-10);
    // Two even steps rather than a long one and a sliver.
    h_ = is_last ? left : (2.0 * h > left ? 0.5 * left : h);
    t1_ = is_last ? t_limit : t0_ + h_;
    std::fill(watch_low_.begin(), watch_low_.end(), 1.0);
    passage.begin_try();
    const double error = try_step(dynamics);
    if (error <= 1.0 && !is_last && passage.wants_other_end()) {
      ++rejections_;
      h = SingularPassage::k_shorter_end * h_;
      continue;
    }
    if (error <= 1.0) {
      const double factor = control_.factor(error, is_retry);
      // A step cut short by the limit says nothing against the longer one that was planned.
      next_h_ = h_ < h ? std::max(h, h_ * factor) : h_ * factor;
      finish_step(dynamics);
      return;
    }
    ++rejections_;
    if (passage.wants_other_stages()) {
      h = SingularPassage::k_shorter_across * h_;
      continue;
    }
    h = std::isfinite(error) ? h_ * std::clamp(0.9 * std::pow(error, -1.0 / order_), k_shortest_retry, 0.9) : 0.2 * h_;
    if (h < 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t0_), 1e-3))
      throw NumericalFailure("step size fell to " + std::to_string(h) + " s at t = " +
                             std::to_string(t0_) +
                             " s: the motion becomes singular there, or the tolerance is too small");
  }
}

} // namespace steplap
