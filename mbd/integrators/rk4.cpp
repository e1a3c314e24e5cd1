// The classical Runge–Kutta method of order 4 with fixed steps, as in the paper (§3).
//
// Dense output: positions by the quintic polynomial with position, velocity and acceleration of both ends (error O(h⁶), less than the
// step's O(h⁵)); velocities by its derivative (O(h⁴), the step's error divided by h). Events located on it therefore keep the order.
#include "mbd/integrators/explicit_runge_kutta.h"
#include "mbd/integrators/methods.h"
#include "mbd/integrators/scene_rate.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

// If a slip law changes velocities faster than the step, steps are shortened to this fraction of its time constant.
constexpr double k_decay_share = 0.5;
// When a slip comes to rest, |ν| → 0, steps decrease in proportion to the power 3/4 of the time left, x, starting at this fraction of
// the characteristic time (0.25 ms for bodies of 1 m). The motion behaves like x^(1+λ), λ > 0, so the sum of the step errors, h⁴ ∫ x³
// x^(λ−4) dx, remains of order 4.
constexpr double k_rest_layer = 2.5e-4 * k_metre_rate;

class Rk4 final : public Integrator {
public:
  Rk4(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), k_(6 * max_dimension), kept_(2 * max_dimension), stride_(max_dimension) {
    set_rate_storage(k_.data(), k_.data() + 5 * stride_);
  }
  [[nodiscard]] const char* name() const override { return "rk4"; }
  [[nodiscard]] bool is_adaptive() const override { return false; }

  void step(Dynamics& dynamics, double t_limit) override {
    const double left = t_limit - t0_;
    if (parts_left_ == 0) cut_step(dynamics, left);
    --parts_left_;
    const bool is_last = is_cut_at_limit_ && parts_left_ == 0;
    h_ = is_last ? left : part_;
    t1_ = is_last ? t_limit : t0_ + h_;
    double share = 1.0;
    while (!try_step(dynamics) || (share = fraction_within_turn_limits(dynamics)) < 1.0) {
      ++rejections_;
      h_ *= share < 1.0 ? share : 0.5;
      if (share < 1.0) note_divided(h_);
      t1_ = t0_ + h_;
      parts_left_ = 0;
    }
    ++steps_;
  }

  void dense(Dynamics& dynamics, double theta, double* out) override {
    hermite_dense(dynamics.coordinate_count(), n_, theta, h_, y0_.data(), y1_.data(), k0_, k1_, out);
    if (h_ < 0.5 * settings_.step) velocities_by_cubic(dynamics.coordinate_count(), theta, out);
  }

  bool end_at(Dynamics& dynamics, double theta) override {
    const double h = h_, t1 = t1_;
    std::copy_n(y1_.begin(), n_, kept_.begin());
    std::copy_n(k1_, n_, kept_.begin() + stride_);
    h_ *= theta;
    t1_ = t0_ + h_;
    if (try_step(dynamics)) return true;
    h_ = h;
    t1_ = t1;
    std::copy_n(kept_.begin(), n_, y1_.begin());
    std::copy_n(kept_.begin() + stride_, n_, k1_);
    return false;
  }

protected:
  void on_restart(Dynamics&) override {
    last_decay_rate_ = 0.0;
    parts_left_ = 0;
  }

private:
  [[nodiscard]] bool try_step(Dynamics& dynamics) {
    begin_event_nodes();
    stage(dynamics, 1, 0.5, k(0));
    stage(dynamics, 2, 0.5, k(1));
    stage(dynamics, 3, 1.0, k(2));
    for (int i = 0; i < n_; ++i) y1_[i] = y0_[i] + h_ / 6.0 * (k(0)[i] + 2.0 * (k(1)[i] + k(2)[i]) + k(3)[i]);
    return try_finish_step(dynamics);
  }
  // Determines the next step and divides it into `division` parts.
  void cut_step(Dynamics& dynamics, double left) {
    double step = limited(next_step(settings_.division * settings_.step));
    const double most = std::min(step, left), turned = limited_by_turns(dynamics, most, 1);
    if (turned < most) {
      step = turned;
      note_divided(step / settings_.division);
    }
    // A remainder of the size of rounding is added to the last step.
    is_cut_at_limit_ = left <= step * (1.0 + 1e-9);
    parts_left_ = settings_.division;
    part_ = (is_cut_at_limit_ ? left : step) / settings_.division;
  }
  double next_step(double longest) {
    const bool is_coming_to_rest = decay_rate_ > last_decay_rate_;
    last_decay_rate_ = decay_rate_;
    if (decay_rate_ == 0.0) return longest;
    const double h = std::min(longest, k_decay_share / decay_rate_);
    if (!is_coming_to_rest) return h;
    const double share = scene_rate(system_) / (k_rest_layer * decay_rate_);
    return std::min(h, longest * std::sqrt(share * std::sqrt(share)));
  }
  // For very short steps velocities are interpolated by cubic polynomials: the derivative of the quintic divides the rounding errors of
  // positions by h.
  void velocities_by_cubic(int n, double theta, double* out) const {
    const double s = theta, r = 1.0 - theta;
    for (int i = n; i < 2 * n; ++i)
      out[i] = r * r * ((1.0 + 2.0 * s) * y0_[i] + s * h_ * k0_[i]) + s * s * ((3.0 - 2.0 * s) * y1_[i] - r * h_ * k1_[i]);
  }
  double* k(int i) { return k_.data() + i * stride_; }
  void stage(Dynamics& dynamics, int index, double c, const double* previous) {
    double* y = scratch_.data();
    for (int i = 0; i < n_; ++i) y[i] = y0_[i] + c * h_ * previous[i];
    evaluate_stage(dynamics, t0_ + c * h_, y, k(index), c);
  }
  std::vector<double> k_, kept_; ///< stages; kept_: state at the end of a step that is repeated in parts
  int stride_;
  double last_decay_rate_ = 0.0; ///< decay rate at the start of the last step, 1/s
  double part_ = 0.0;            ///< length of a part of the present step, s
  int parts_left_ = 0;           ///< number of parts of the present step still to be made
  bool is_cut_at_limit_ = false; ///< the step ends at the limit
};

} // namespace

std::unique_ptr<Integrator> make_rk4(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Rk4>(dynamics, settings, max_dimension);
}

void hermite_dense(int coordinates, int dimension, double theta, double h, const double* y0, const double* y1, const double* rate0,
                   const double* rate1, double* out) {
  const int n = coordinates;
  const double s = theta, s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
  // Quintic basis functions on [0, 1] for (q0, h v0, h² a0, q1, h v1, h² a1), and their derivatives.
  const double b1 = s - 6 * s3 + 8 * s4 - 3 * s5;
  const double b2 = 0.5 * (s2 - 3 * s3 + 3 * s4 - s5);
  const double b3 = 10 * s3 - 15 * s4 + 6 * s5;
  const double b4 = -4 * s3 + 7 * s4 - 3 * s5;
  const double b5 = 0.5 * (s3 - 2 * s4 + s5);
  const double d1 = 1 - 18 * s2 + 32 * s3 - 15 * s4;
  const double d2 = 0.5 * (2 * s - 9 * s2 + 12 * s3 - 5 * s4);
  const double d3 = 30 * s2 - 60 * s3 + 30 * s4;
  const double d4 = -12 * s2 + 28 * s3 - 15 * s4;
  const double d5 = 0.5 * (3 * s2 - 8 * s3 + 5 * s4);
  for (int i = 0; i < n; ++i) {
    const double change = y1[i] - y0[i];
    const double v0 = y0[n + i], v1 = y1[n + i], a0 = rate0[n + i], a1 = rate1[n + i];
    out[i] = y0[i] + b3 * change + h * (b1 * v0 + b4 * v1) + h * h * (b2 * a0 + b5 * a1);
    out[n + i] = d3 * change / h + d1 * v0 + d4 * v1 + h * (d2 * a0 + d5 * a1);
  }
  const double c1 = s - 2 * s2 + s3, c2 = 3 * s2 - 2 * s3, c3 = s3 - s2;
  for (int i = 2 * n; i < dimension; ++i) out[i] = y0[i] + c2 * (y1[i] - y0[i]) + h * (c1 * rate0[i] + c3 * rate1[i]);
}

} // namespace steplap
