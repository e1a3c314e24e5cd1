#include "mbd/integrators/explicit_pair.h"

#include <limits>

namespace steplap {

namespace {

constexpr double k_shortest_retry = 0.1, k_shortest_retry_near_singular = 0.7;
constexpr double k_end_pivot = 1e-6; // a thousandth of a radian from where two rods fold, squared
constexpr double k_shortening = 0.75;
constexpr int k_max_near_misses = 2;

bool ends_singular(const Dynamics& dynamics) {
  const Layout& layout = dynamics.layout();
  return !layout.active.empty() && layout.schur.smallest_pivot() < k_end_pivot;
}

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
  int near_misses = 0;
  for (bool is_retry = false;; is_retry = true) {
    const bool is_last = h >= left * (1.0 - 1e-10);
    // Two even steps rather than a long one and a sliver.
    h_ = is_last ? left : (2.0 * h > left ? 0.5 * left : h);
    t1_ = is_last ? t_limit : t0_ + h_;
    std::fill(watch_low_.begin(), watch_low_.end(), 1.0);
    const double error = try_step(dynamics);
    // A step never ends at a singular position if it need not: from there none would be precise.
    if (error <= 1.0 && !is_last && near_misses < k_max_near_misses && ends_singular(dynamics)) {
      ++near_misses;
      ++rejections_;
      h = k_shortening * h_;
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
    // Near a singular position it is chance how close a stage comes to it: a step a little shorter may pass,
    // one that always ends short of it never does.
    const double shortest = dynamics.is_near_singular() ? k_shortest_retry_near_singular : k_shortest_retry;
    h = std::isfinite(error) ? h_ * std::clamp(0.9 * std::pow(error, -1.0 / order_), shortest, 0.9) : 0.2 * h_;
    if (h < 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t0_), 1e-3))
      throw NumericalFailure("step size fell to " + std::to_string(h) + " s at t = " +
                             std::to_string(t0_) +
                             " s: the motion becomes singular there, or the tolerance is too small");
  }
}

} // namespace steplap
