// TimeStepping (time_stepping.h) as an integrator: it decides contact modes and friction phases itself.
#include "mbd/integrators/methods.h"
#include "mbd/integrators/time_stepping.h"

#include <algorithm>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_stretch = 1e-6; // of a step, by which steps may be longer than asked for

class Moreau final : public Integrator {
public:
  Moreau(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), stepping_(system_), k_(2 * max_dimension) {
    set_rate_storage(k_.data(), k_.data() + max_dimension);
  }
  [[nodiscard]] const char* name() const override { return "moreau"; }
  [[nodiscard]] bool is_adaptive() const override { return false; }
  [[nodiscard]] const State* stepped_state() const override { return &state_; }

  void step(Dynamics& dynamics, double t_limit) override {
    // As many equal steps as there is room for up to the limit: sums of steps end beside it by rounding, and a last
    // step of that length would tell nothing but rounding.
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
    // Both ends in the layout of the new phases, so that one can interpolate between them.
    n_ = dynamics.dimension();
    dynamics.pack(start_, y0_.data());
    dynamics.pack(state_, y1_.data());
    std::fill(watch1_.begin(), watch1_.end(), 1.0); // nobody looks for events here, nor at rates: the run begins anew
    ++steps_;
  }

  /// Straight between the ends, as the method sees the motion.
  void dense(Dynamics&, double theta, double* out) override {
    for (int i = 0; i < n_; ++i) out[i] = y0_[i] + theta * (y1_[i] - y0_[i]);
  }

private:
  // How many equal ones: of a finer run `division` for each that the longer steps have up to the same limit.
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
  double limit_ = -1.0; ///< of the steps of length part_, s
  double part_ = 0.0;   ///< s
};

} // namespace

std::unique_ptr<Integrator> make_moreau(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Moreau>(dynamics, settings, max_dimension);
}

} // namespace steplap
