// TimeStepping (time_stepping.h) as an integrator. It determines contact modes and friction phases itself.
#include "mbd/integrators/methods.h"
#include "mbd/integrators/time_stepping.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_stretch = 1e-6; // steps may be longer than requested by this relative amount

class Moreau final : public Integrator {
public:
  Moreau(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), stepping_(system_), k_(2 * max_dimension) {
    stepping_.resolve_impacts();
    set_rate_storage(k_.data(), k_.data() + max_dimension);
  }
  [[nodiscard]] const char* name() const override { return "moreau"; }
  [[nodiscard]] bool is_adaptive() const override { return false; }
  [[nodiscard]] const State* stepped_state() const override { return &state_; }

  void step(Dynamics& dynamics, double t_limit) override {
    // The remaining time up to the limit is divided into equal steps. A sum of steps would miss the limit by rounding, and require a
    // meaningless last step of that length.
    const double left = t_limit - t0_, count = steps_to(t_limit, left);
    h_ = count > 1.0 ? left / count : left;
    const double turned = limited_by_turns(dynamics, h_, settings_.division);
    const bool is_divided = turned < h_;
    if (is_divided) note_divided(turned);
    h_ = turned;
    t1_ = count > 1.0 || is_divided ? t0_ + h_ : t_limit;
    state_ = dynamics.state();
    dynamics.unpack(t0_, y0_.data(), state_);
    start_ = state_;
    stepping_.step(dynamics, state_, t1_, settings_.projection_tolerance);
    residual_.position = std::max(residual_.position, stepping_.residual().position);
    residual_.velocity = std::max(residual_.velocity, stepping_.residual().velocity);
    // Both ends are packed in the layout of the new phases, because interpolation needs equal layouts.
    n_ = dynamics.dimension();
    dynamics.pack(start_, y0_.data());
    dynamics.pack(state_, y1_.data());
    // Event functions and rates are not used: the method restarts after each step.
    std::fill(event_value1_.begin(), event_value1_.end(), 1.0);
    ++steps_;
  }

  /// Linear interpolation between the ends, as the method assumes for the motion.
  void dense(Dynamics&, double theta, double* out) override {
    for (int i = 0; i < n_; ++i) out[i] = y0_[i] + theta * (y1_[i] - y0_[i]);
  }

private:
  // Returns the number of equal steps up to the limit. In a finer run it is `division` times the number of undivided steps up to the same
  // limit.
  [[nodiscard]] double steps_to(double t_limit, double left) {
    if (settings_.division == 1) return std::ceil(left / limited(settings_.step) - k_stretch);
    if (t_limit != limit_) {
      limit_ = t_limit;
      part_ = left / (settings_.division * std::max(1.0, std::ceil(left / limited(settings_.division * settings_.step) - k_stretch)));
    }
    return std::round(left / part_);
  }

  TimeStepping stepping_;
  State state_, start_;
  std::vector<double> k_;
  double limit_ = -1.0; ///< limit for which part_ was computed, s
  double part_ = 0.0;   ///< length of the divided steps up to limit_, s
};

} // namespace

std::unique_ptr<Integrator> make_moreau(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Moreau>(dynamics, settings, max_dimension);
}

} // namespace steplap
