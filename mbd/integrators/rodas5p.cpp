// Rodas5P (tableau_rodas5p.h): linearly implicit, L-stable, order 5, for stiff scenes.
//
// It is applied to the equations of motion with eliminated multipliers (index 1); the linear systems of the stages contain the exact
// linearisation and the constraints (stage_system.h). Each step needs one linearisation, one factorisation and eight evaluations of
// accelerations. Explicit time dependence (drives, loads) enters by ∂F/∂t at the start of the step, a forward difference of order 4 over a
// fraction of the step, which preserves the order of the method. F is smooth within a step.
//
// Dissipated energy and work are integrated by Lobatto's rule with four points (order 6) on the dense output. The difference to the rule
// with the two inner points (order 2) estimates the error, which enters the error of the step. The two inner points are also the nodes for
// event functions, since the stages of this method do not approximate the motion.
//
// A singular position of joints ahead is crossed as in explicit methods (singular_crossing.h), because the linearisation is useless there.
// If forces are too stiff for that, ordinary steps continue.
#include "mbd/base/portable_math.h"
#include "mbd/integrators/explicit_runge_kutta.h"
#include "mbd/integrators/methods.h"
#include "mbd/integrators/singular_crossing.h"
#include "mbd/integrators/stage_system.h"
#include "mbd/integrators/tableau_rodas5p.h"

#include <limits>
#include <memory>

namespace steplap {

namespace {

constexpr double k_time_step = 1.0 / 32.0; // distance of the points for ∂F/∂t, relative to h
constexpr double k_share_of_cube = 0.1;
const double k_lobatto[2] = {0.5 - std::sqrt(0.05), 0.5 + std::sqrt(0.05)};

class Rodas5p final : public Integrator {
public:
  Rodas5p(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), k_(2 * max_dimension), u_(8 * max_dimension), rate_(max_dimension),
        slope_(max_dimension), right_(max_dimension), raw_(max_dimension), stride_(max_dimension), next_h_(settings.step) {
    slip_care_ = 0.1; // same reason as in tsit5: the dense output is not checked
    set_rate_storage(k_.data(), k_.data() + stride_);
    control_.order = 5;
  }
  void propose_step(double h) override { next_h_ = h; }
  void reserve(Dynamics& dynamics, double t, const double* y) override {
    constexpr double k_any_step = 1e-6; // first step of reserve(), s; any length is suitable
    linearization_.evaluate(dynamics, t, y);
    system_of_stages_.set(linearization_, dynamics.layout());
    static_cast<void>(system_of_stages_.factor(k_any_step));
  }
  [[nodiscard]] const char* name() const override { return "rodas5p"; }
  [[nodiscard]] bool is_adaptive() const override { return true; }

  void step(Dynamics& dynamics, double t_limit) override;

  void dense(Dynamics& dynamics, double theta, double* out) override {
    if (is_crossing_) return crossing_->dense(theta, crossing_step(dynamics), out);
    interpolate(theta, out);
    // Integral of the cubic through the powers at the Lobatto points.
    const int e = n_ - 2;
    for (int i = 0; i < 2; ++i)
      out[e + i] = y0_[e + i] + power_span_ * h_ * power_integral(theta / power_span_, power_[i]) + theta * settled_[i];
  }

  void cut_at(Dynamics& dynamics, double theta) override;

protected:
  void on_restart(Dynamics&) override {
    control_.previous_error = 1e-4;
    approach_.restart();
  }
  [[nodiscard]] bool withdraw(Dynamics& dynamics, double h) override {
    if (is_crossing_) return false;
    --steps_;
    ++rejections_;
    approach_ = saved_control_.approach;
    control_.previous_error = saved_control_.error;
    next_h_ = h;
    refuse_shorter_than_rounding(h);
    dynamics.rates(t0_, y0_.data(), scratch_.data()); // leaves `dynamics` evaluated at the start of the next attempt
    return true;
  }

private:
  double* u(int i) { return u_.data() + i * stride_; }
  double try_step(Dynamics& dynamics);
  void find_time_slope(Dynamics& dynamics);
  void finish_powers(Dynamics& dynamics);
  void interpolate(double theta, double* out);
  bool cross_singularity(Dynamics& dynamics, double left);
  void note_end(const Dynamics& dynamics);
  static double power_integral(double theta, const double* power);
  [[nodiscard]] double error_of_powers() const;

  std::vector<double> k_, u_, rate_, slope_, right_, raw_;
  int stride_;
  double settled_[2] = {};
  double power_[2][4] = {}; ///< powers of dissipation and work at 0, the two inner Lobatto points, and 1
  double power_span_ = 1.0; ///< fraction of the step that the points of power_ span
  Linearization linearization_;
  StageSystem system_of_stages_;
  StepControl control_;
  double next_h_ = 0.0;
  std::unique_ptr<SingularCrossing> crossing_; ///< created when the first crossing occurs
  SingularApproach approach_;
  bool is_crossing_ = false; ///< the last step is a singular crossing
  /// Step-control data before the last step, restored by withdraw().
  struct SavedControl {
    SingularApproach approach;
    double error = 1e-4;
  };
  SavedControl saved_control_;
};

// Computes ∂F/∂t at (t0, y0) by forward differences with five points (order 4).
void Rodas5p::find_time_slope(Dynamics& dynamics) {
  const double d = k_time_step * h_;
  const int n = n_ - 2;
  constexpr double weights[4] = {4.0, -3.0, 4.0 / 3.0, -0.25};
  double* const f = rate_.data();
  bool is_still = true;
  for (int i = 0; i < n; ++i) slope_[i] = -25.0 / 12.0 * k0_[i] / d;
  for (int p = 3; p >= 0; --p) {
    dynamics.evaluate(Request::rates_without_projection, t0_ + (p + 1) * d, y0_.data(), f);
    is_still = is_still && std::equal(f, f + n, k0_);
    if (is_still && p < 3) break; // equal at the first three points: no explicit time dependence
    for (int i = 0; i < n; ++i) slope_[i] += weights[p] / d * f[i];
  }
  if (is_still) std::fill(slope_.begin(), slope_.end(), 0.0);
}

double Rodas5p::try_step(Dynamics& dynamics) {
  using namespace rodas5p;
  const int n = n_ - 2;
  find_time_slope(dynamics);
  if (!system_of_stages_.factor(gamma * h_)) return std::numeric_limits<double>::infinity();
  double* const y = scratch_.data();
  std::copy(y0_.begin(), y0_.begin() + n_, y);
  for (std::size_t i = 0; i < 8; ++i) {
    for (int k = 0; k < n; ++k) {
      double sum = 0.0, carried = 0.0;
      for (std::size_t j = 0; j < i; ++j) {
        sum += a[i][j] * u_[j * stride_ + k];
        carried += C[i][j] * u_[j * stride_ + k];
      }
      y[k] = y0_[k] + sum;
      right_[k] = carried / h_ + gamma_i[i] * h_ * slope_[k];
    }
    const double* f = k0_;
    if (i > 0) {
      dynamics.evaluate(Request::rates_without_projection, t0_ + c[i] * h_, y, rate_.data());
      f = rate_.data();
    }
    for (int k = 0; k < n; ++k) right_[k] += f[k];
    system_of_stages_.solve(right_.data(), u(static_cast<int>(i)));
  }
  // The argument of the last stage is the embedded solution, so u of this stage is the error estimate.
  const double* const last = u(7);
  for (int k = 0; k < n; ++k) y1_[k] = y[k] + last[k];
  std::copy(last, last + n, scratch_.begin());
  scratch_[n] = scratch_[n + 1] = 0.0;
  y1_[n] = y0_[n];
  y1_[n + 1] = y0_[n + 1];
  std::copy(y1_.begin(), y1_.begin() + n_, raw_.begin());
  return error_norm(scratch_.data());
}

void Rodas5p::interpolate(double theta, double* out) {
  using namespace rodas5p;
  const double s = theta, r = 1.0 - theta;
  double weight[8];
  for (std::size_t j = 0; j < 8; ++j) weight[j] = s * r * (H[0][j] + s * (H[1][j] + s * H[2][j]));
  // The displacement by projection is distributed smoothly over the step, so that the dense output ends at the projected state.
  const double blend = s * s * (3.0 - 2.0 * s);
  // Computed as position at the start plus displacement. The form (1 − s) y₀ + s y₁ would change a constant position by rounding, and
  // contacts at rest would open or close.
  for (int i = 0; i < n_ - 2; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < 8; ++j) sum += weight[j] * u_[j * stride_ + i];
    out[i] = y0_[i] + (s * (raw_[i] - y0_[i]) + sum + blend * (y1_[i] - raw_[i]));
  }
}

// Returns ∫₀^θ of the cubic with the values `power` at 0, a, 1 − a, 1, by Newton's divided differences.
double Rodas5p::power_integral(double theta, const double* power) {
  const double x[4] = {0.0, k_lobatto[0], k_lobatto[1], 1.0};
  double d[4] = {power[0], power[1], power[2], power[3]};
  for (int level = 1; level < 4; ++level)
    for (int i = 3; i >= level; --i) d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - level]);
  const double t2 = theta * theta / 2.0, t3 = theta * theta * theta / 3.0, t4 = theta * theta * theta * theta / 4.0;
  const double s = x[1] + x[2], p = x[1] * x[2];
  return d[0] * theta + d[1] * t2 + d[2] * (t3 - x[1] * t2) + d[3] * (t4 - s * t3 + p * t2);
}

void Rodas5p::finish_powers(Dynamics& dynamics) {
  const int e = n_ - 2;
  power_span_ = 1.0;
  for (int i = 0; i < 2; ++i) power_[i][0] = k0_[e + i];
  std::vector<double>& y = scratch_;
  y[e] = y[e + 1] = 0.0;
  for (int p = 0; p < 2; ++p) {
    interpolate(k_lobatto[p], y.data());
    dynamics.rates(t0_ + k_lobatto[p] * h_, y.data(), rate_.data());
    record_stage_events(dynamics, rate_.data(), k_lobatto[p]);
    for (int i = 0; i < 2; ++i) power_[i][p + 1] = rate_[e + i];
  }
  for (int i = 0; i < 2; ++i) {
    power_[i][3] = k1_[e + i];
    settled_[i] = y1_[e + i] - y0_[e + i]; // change of the energy integrals when inner states were corrected at the end of the step
    y1_[e + i] += h_ * power_integral(1.0, power_[i]);
  }
}

// Integrates energy and work up to θ by a Lobatto rule of its own. The cubic through the powers of the whole step is less accurate at θ
// than at its end, and after an event at θ these powers may belong to a law that is no longer valid.
void Rodas5p::cut_at(Dynamics& dynamics, double theta) {
  if (is_crossing_ || !(theta > 0.0) || theta == power_span_) return;
  const int e = n_ - 2;
  std::vector<double>& y = scratch_;
  y[e] = y[e + 1] = 0.0;
  constexpr int k_points = 3;
  const double points[k_points] = {k_lobatto[0], k_lobatto[1], 1.0};
  for (int p = 0; p < k_points; ++p) {
    interpolate(points[p] * theta, y.data());
    dynamics.rates(t0_ + points[p] * theta * h_, y.data(), rate_.data());
    for (int i = 0; i < 2; ++i) power_[i][p + 1] = rate_[e + i];
  }
  power_span_ = theta;
}

// Error estimate of the integrals. For a power cos φτ that turns by φ within the step, the relative error of the four-point rule is
// φ⁶/1.5e6, and that of the two-point rule δ = φ²/20. The former is about δ³/100; ten times that is used.
double Rodas5p::error_of_powers() const {
  const int e = n_ - 2;
  double worst = 0.0;
  for (int i = 0; i < 2; ++i) {
    const double* p = power_[i];
    const double largest = std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2]), std::abs(p[3])});
    if (largest == 0.0) continue;
    const double share = std::abs((p[0] + p[3] + 5.0 * (p[1] + p[2])) / 12.0 - 0.5 * (p[1] + p[2])) / largest;
    worst = std::max(worst, k_share_of_cube * h_ * largest * share * share * share * weight_[e + i]);
  }
  return worst / std::sqrt(static_cast<double>(n_)); // divided by √n because the error norm is a root mean square over n numbers
}

// After an attempt that came near a singular position: crosses that position by one collocation step, with the position between two
// stages. Returns true if this succeeded.
bool Rodas5p::cross_singularity(Dynamics& dynamics, double left) {
  if (!crossing_) crossing_ = std::make_unique<SingularCrossing>(stride_);
  const double ahead = h_ * crossing_->locate(dynamics, crossing_step(dynamics));
  const double h = ahead > 0.0 ? crossing_->length_with_gap_at(ahead, left) : 0.0;
  if (h == 0.0) return false;
  h_ = h;
  t1_ = t0_ + h_;
  begin_event_nodes();
  is_crossing_ = crossing_->cross(dynamics, crossing_step(dynamics), y1_.data()) <= 1.0;
  return is_crossing_ && try_finish_step(dynamics);
}

void Rodas5p::note_end(const Dynamics& dynamics) {
  ++steps_;
  saved_control_.approach = approach_;
  approach_.note_end(dynamics.layout().active.empty() ? 1.0 : dynamics.smallest_pivot());
}

void Rodas5p::step(Dynamics& dynamics, double t_limit) {
  const double left = t_limit - t0_;
  const double h_max = limited_by_turns(dynamics, limited(left), settings_.division);
  if (next_h_ <= 0.0) next_h_ = first_step(dynamics, 4, h_max);
  update_weights(dynamics);
  double h = std::min(next_h_, h_max);
  if (is_restarted_) h = restrained_step(dynamics, h);
  linearization_.evaluate(dynamics, t0_, y0_.data());
  system_of_stages_.set(linearization_, dynamics.layout());
  bool has_tried_crossing = false;
  for (bool is_retry = false;; is_retry = true) {
    is_crossing_ = false;
    const bool is_last = h >= left * (1.0 - 1e-10);
    h_ = is_last ? left : (2.0 * h > left ? 0.5 * left : h);
    t1_ = is_last ? t_limit : t0_ + h_;
    dynamics.reset_least_pivot();
    double error = std::numeric_limits<double>::infinity();
    (void)try_evaluation(h_, [&] { error = try_step(dynamics); });
    if (!has_tried_crossing && approach_.is_ahead(dynamics.least_pivot())) [[unlikely]] {
      has_tried_crossing = true;
      if (cross_singularity(dynamics, left)) return note_end(dynamics);
      continue;
    }
    if (error <= 1.0) {
      begin_event_nodes();
      if (!try_finish_step(dynamics)) error = std::numeric_limits<double>::infinity();
      else finish_powers(dynamics);
    }
    if (error <= 1.0) error = std::max(error, error_of_powers());
    if (error <= 1.0) {
      saved_control_.error = control_.previous_error;
      const double factor = control_.factor(error, is_retry);
      next_h_ = h_ < h ? std::max(h, h_ * factor) : h_ * factor;
      return note_end(dynamics);
    }
    ++rejections_;
    h = std::isfinite(error) ? h_ * std::clamp(0.9 * portable::pow(error, -1.0 / control_.order), 0.1, 0.9) : 0.2 * h_;
    refuse_shorter_than_rounding(h);
  }
}

} // namespace

std::unique_ptr<Integrator> make_rodas5p(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Rodas5p>(dynamics, settings, max_dimension);
}

} // namespace steplap
