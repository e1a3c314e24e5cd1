// Explicit until stiffness shows, then implicit, and back.
//
// Explicit: dop853, at tolerances above 1e-5 tsit5. Stiffness shows where the step is as long as stability
// allows, several steps in a row (Integrator::stability_share); Rodas5P goes on from there. After a number
// of implicit steps, or when they have become little longer than what explicit ones could be, the explicit
// method is tried again: being wrong costs it a handful of steps, a few percent of the implicit ones.
#include "mbd/integrators/methods.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr double k_loose = 1e-5;         // tolerance above which order 5 is cheaper than order 8
constexpr double k_limited = 0.8;        // share of the stability bound that counts as limited by it
constexpr int k_steps_limited = 5;       // in a row (each must be; an accurate step is well below)
constexpr int k_steps_implicit = 60;     // before the explicit method is tried again
constexpr double k_worth = 6.0;          // an implicit step costs about as much as so many explicit ones

class Automatic final : public Integrator {
public:
  Automatic(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), k_(2 * max_dimension),
        explicit_(settings.tolerance > k_loose ? make_tsit5(dynamics, settings, max_dimension)
                                               : make_dop853(dynamics, settings, max_dimension)),
        settings_of_implicit_(settings), max_dimension_(max_dimension), active_(explicit_.get()) {
    set_rate_storage(k_.data(), k_.data() + max_dimension);
  }
  [[nodiscard]] const char* name() const override { return "auto"; }
  [[nodiscard]] bool is_adaptive() const override { return true; }
  [[nodiscard]] WatchNodes& watch_nodes() override { return active_->watch_nodes(); }
  void expect_looks(bool are_expected) override {
    Integrator::expect_looks(are_expected);
    explicit_->expect_looks(are_expected);
    if (implicit_) implicit_->expect_looks(are_expected);
  }
  [[nodiscard]] bool bears_look(Dynamics& dynamics) override {
    const bool bears = active_->bears_look(dynamics);
    if (!bears) note_counts();
    return bears;
  }
  void limit_step(double longest) override {
    Integrator::limit_step(longest);
    explicit_->limit_step(longest);
    if (implicit_) implicit_->limit_step(longest);
  }

  void step(Dynamics& dynamics, double t_limit) override { step_by_parts(dynamics, t_limit); }

  void begin_step(Dynamics& dynamics, double t_limit) override {
    choose(dynamics);
    if (!is_started_) active_->restart(dynamics, t0_, y0_.data());
    is_started_ = true;
    active_->begin_step(dynamics, t_limit);
  }

  void make_try(Dynamics& dynamics) override { active_->make_try(dynamics); }

  [[nodiscard]] LaneTry* lane_try() override { return active_->lane_try(); }

  [[nodiscard]] bool conclude_try(Dynamics& dynamics) override {
    if (!active_->conclude_try(dynamics)) return false;
    t1_ = active_->t1();
    h_ = active_->h();
    std::copy(active_->y1(), active_->y1() + n_, y1_.begin());
    std::copy(active_->rate1(), active_->rate1() + n_, k1_);
    watch1_ = active_->watch1();
    watch_rate1_ = active_->watch_rate1();
    note_counts();
    residual_.position = std::max(residual_.position, active_->max_position_residual());
    residual_.velocity = std::max(residual_.velocity, active_->max_velocity_residual());
    judge(dynamics);
    return true;
  }

  void dense(Dynamics& dynamics, double theta, double* out) override { active_->dense(dynamics, theta, out); }

  void accept() override {
    Integrator::accept();
    active_->accept();
  }

protected:
  void on_restart(Dynamics&) override { is_started_ = false; }

private:
  void note_counts() {
    steps_ = explicit_->steps() + (implicit_ ? implicit_->steps() : 0);
    rejections_ = explicit_->rejections() + (implicit_ ? implicit_->rejections() : 0);
  }

  // Counts what speaks for the other method; the change itself waits until the step has been used.
  void judge(Dynamics& dynamics) {
    if (active_ == explicit_.get()) {
      const double share = active_->stability_share(dynamics);
      count_ = share > k_limited ? count_ + 1 : 0;
      if (share > 0.0) explicit_step_ = h_ / share;
    } else {
      ++count_;
      if (h_ < k_worth * explicit_step_) count_ += k_steps_implicit / 6;
    }
  }

  void choose(Dynamics& dynamics) {
    if (count_ < (active_ == explicit_.get() ? k_steps_limited : k_steps_implicit)) return;
    count_ = 0;
    is_started_ = false;
    if (active_ != explicit_.get()) {
      active_ = explicit_.get();
      return;
    }
    // The first step of the implicit method: what the explicit one has made, ten times.
    if (!implicit_) {
      settings_of_implicit_.step = 10.0 * explicit_step_;
      implicit_ = make_rodas5p(dynamics, settings_of_implicit_, max_dimension_);
      implicit_->limit_step(longest_step_);
      implicit_->expect_looks(are_looks_expected());
    }
    active_ = implicit_.get();
  }

  std::vector<double> k_;
  std::unique_ptr<Integrator> explicit_, implicit_;
  IntegratorSettings settings_of_implicit_;
  int max_dimension_;
  Integrator* active_;
  bool is_started_ = false;
  int count_ = 0;
  double explicit_step_ = 0.0; ///< the longest that stability allows, s
};

} // namespace

std::unique_ptr<Integrator> make_automatic(const Dynamics& dynamics, const IntegratorSettings& settings,
                                           int max_dimension) {
  return std::make_unique<Automatic>(dynamics, settings, max_dimension);
}

} // namespace steplap
