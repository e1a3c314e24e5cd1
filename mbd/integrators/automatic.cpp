// Automatic choice between an explicit and an implicit method.
//
// The explicit method is dop853, for tolerances above 1e-5 tsit5. If several consecutive steps are limited by stability
// (Integrator::stability_share), Rodas5P continues. The explicit method is tried again after a number of implicit steps, or when these are
// little longer than explicit ones could be. A wrong trial costs a handful of steps, a few percent of the implicit ones.
//
// At tight tolerances explicit steps in a stiff scene stay well below the stability limit, because the remaining fast motion, even its
// rounding errors, must be damped below the tolerance within each step. Such steps are recognised by a stability share that is on average
// far above that of an accurate step. The implicit method is then tried, and kept only if its longer steps outweigh their higher cost.
// After each unsuccessful trial the waiting time before the next one is doubled. When the implicit method, after many steps, yields to the
// explicit one for comparison, the step length to be reached is known.
#include "mbd/base/portable_math.h"
#include "mbd/integrators/methods.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr double k_loose = 1e-5;  // tolerance above which order 5 is cheaper than order 8
constexpr double k_limited = 0.8; // stability share from which a step counts as limited by stability
// Consecutive limited steps before the implicit method continues; accurate steps have shares far below k_limited.
constexpr int k_steps_limited = 5;
constexpr int k_steps_implicit = 60; // implicit steps before the explicit method is tried again
constexpr double k_worth = 6.0;      // cost of an implicit step relative to an explicit one
// Stability share of an accurate dop853 step on an oscillation at tolerance 1e-8; proportional to the eighth root of the tolerance.
constexpr double k_accurate_share = 0.26;
// Factor on k_accurate_share: a higher mean share indicates that stability, not accuracy, limits the step.
constexpr double k_suspicious = 2.0;
constexpr double k_memory = 1.0 / 16.0; // weight of the last step in running averages
// Explicit steps before the first trial of the implicit method, so that the averages cover these steps only.
constexpr int k_steps_before_trial = 32;
// Upper limit of steps between trials: an unsuccessful trial costs about 40 explicit steps, so at most 4 %.
constexpr long k_most_before_trial = 1024;
// After this many explicit steps the implicit method is tried even if the steps seem accurate, because k_accurate_share is known for
// oscillations only. The number is multiplied by four after each unsuccessful trial, so that all trials together cost a few percent of a
// long run.
constexpr long k_steps_before_any = 128;
constexpr int k_steps_to_grow = 8; // steps of a resumed method until its length is representative, with a growth of up to six per step
// Steps that grow by more than this factor are not compared: after an event a trial begins with short steps.
constexpr double k_grows = 1.2;

class Automatic final : public Integrator {
public:
  Automatic(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension)
      : Integrator(dynamics, settings, max_dimension), k_(2 * max_dimension),
        explicit_(settings.tolerance > k_loose ? make_tsit5(dynamics, settings, max_dimension)
                                               : make_dop853(dynamics, settings, max_dimension)),
        implicit_(make_rodas5p(dynamics, settings, max_dimension)), active_(explicit_.get()),
        suspicious_share_(std::min(k_limited, k_suspicious * k_accurate_share * portable::pow(settings.tolerance / 1e-8, 1.0 / 8.0))) {
    set_rate_storage(k_.data(), k_.data() + max_dimension);
  }
  [[nodiscard]] const char* name() const override { return "auto"; }
  [[nodiscard]] bool is_adaptive() const override { return true; }
  [[nodiscard]] EventNodes& event_nodes() override { return active_->event_nodes(); }
  void expect_dense_evaluations(bool are_expected) override {
    Integrator::expect_dense_evaluations(are_expected);
    explicit_->expect_dense_evaluations(are_expected);
    implicit_->expect_dense_evaluations(are_expected);
  }
  [[nodiscard]] bool dense_output_is_accurate(Dynamics& dynamics) override {
    const bool bears = active_->dense_output_is_accurate(dynamics);
    if (!bears) note_counts();
    return bears;
  }
  [[nodiscard]] bool resolves_slips(Dynamics& dynamics, double theta, const double* y) override {
    const bool resolves = active_->resolves_slips(dynamics, theta, y);
    if (!resolves) note_counts();
    return resolves;
  }
  [[nodiscard]] bool shorten(Dynamics& dynamics, double share) override {
    const bool is_shortened = active_->shorten(dynamics, share);
    if (is_shortened) note_counts();
    return is_shortened;
  }
  void limit_step(double longest) override {
    Integrator::limit_step(longest);
    explicit_->limit_step(longest);
    implicit_->limit_step(longest);
  }

  void step(Dynamics& dynamics, double t_limit) override {
    choose(dynamics);
    if (!is_started_) active_->restart(dynamics, t0_, y0_.data());
    is_started_ = true;
    active_->step(dynamics, t_limit);
    t1_ = active_->t1();
    h_ = active_->h();
    std::copy(active_->y1(), active_->y1() + n_, y1_.begin());
    std::copy(active_->rate1(), active_->rate1() + n_, k1_);
    event_value1_ = active_->event_value1();
    event_derivative1_ = active_->event_derivative1();
    note_counts();
    residual_.position = std::max(residual_.position, active_->max_position_residual());
    residual_.velocity = std::max(residual_.velocity, active_->max_velocity_residual());
    judge(dynamics);
  }

  void cut_at(Dynamics& dynamics, double theta) override { active_->cut_at(dynamics, theta); }
  void dense(Dynamics& dynamics, double theta, double* out) override { active_->dense(dynamics, theta, out); }

  void accept() override {
    Integrator::accept();
    active_->accept();
  }

protected:
  void on_restart(Dynamics& dynamics) override {
    is_started_ = false;
    if (is_warm_) return;
    is_warm_ = true;
    implicit_->reserve(dynamics, t0_, y0_.data());
  }

private:
  void note_counts() {
    steps_ = explicit_->steps() + implicit_->steps();
    rejections_ = explicit_->rejections() + implicit_->rejections();
    rounded_tolerance_ = std::max(explicit_->rounded_tolerance(), implicit_->rounded_tolerance());
  }

  // Updates the criteria for a change of method. The change itself is made after the step has been used.
  void judge(Dynamics& dynamics) {
    if (active_ == explicit_.get()) {
      const double share = active_->stability_share(dynamics);
      count_ = share > k_limited ? count_ + 1 : 0;
      if (share > 0.0) explicit_step_ = h_ / share;
      mean_share_ += k_memory * (std::min(share, 1.0) - mean_share_);
      mean_step_ = steps_explicit_ == 0 ? h_ : mean_step_ + k_memory * (h_ - mean_step_);
      ++steps_explicit_;
    } else {
      ++count_;
      if (h_ < k_worth * explicit_step_ && !(is_trial_ && h_ > k_grows * last_step_)) count_ += k_steps_implicit / 6;
    }
    last_step_ = h_;
  }

  // Returns true if the implicit method should be tried: either its last known step was so much longer that it would be faster, or the
  // mean stability share is too high for a step that accuracy limits.
  [[nodiscard]] bool is_trial_due() const {
    if (steps_explicit_ >= k_steps_to_grow && k_worth * h_ < implicit_step_ && k_worth * mean_step_ < implicit_step_) return true;
    if (steps_explicit_ >= steps_before_any_ && mean_share_ > 0.5 * suspicious_share_) return true;
    return steps_explicit_ >= steps_before_trial_ && mean_share_ > suspicious_share_;
  }

  void choose(Dynamics& dynamics) {
    const bool is_explicit = active_ == explicit_.get();
    // No trial while friction depends on slip velocity: the stiffness of a slip law ends before the trial would pay.
    const bool is_trial = is_explicit && count_ < k_steps_limited && is_trial_due() && !dynamics.depends_on_slip_direction();
    if (count_ < (is_explicit ? k_steps_limited : k_steps_implicit) && !is_trial) return;
    count_ = 0;
    is_started_ = false;
    if (!is_explicit) {
      const bool is_in_vain = implicit_->steps() - implicit_steps_before_ <
                              // Fewer steps: the trial was ended by short steps, each of which adds k_steps_implicit / 6 to count_.
                              k_steps_implicit / 2;
      if (is_trial_) steps_before_trial_ = is_in_vain ? std::min(2 * steps_before_trial_, k_most_before_trial) : k_steps_before_trial;
      if (is_trial_) steps_before_any_ = is_in_vain ? 4 * steps_before_any_ : k_steps_before_any;
      implicit_step_ = is_in_vain ? 0.0 : h_;
      active_ = explicit_.get();
      steps_explicit_ = 0;
      return;
    }
    is_trial_ = is_trial;
    if (is_trial) explicit_step_ = mean_step_;
    if (implicit_->steps() == 0) implicit_->propose_step(10.0 * explicit_step_); // first guess, if no implicit step has been made yet
    active_ = implicit_.get();
    implicit_steps_before_ = implicit_->steps();
  }

  std::vector<double> k_;
  std::unique_ptr<Integrator> explicit_, implicit_; ///< both are created at the start, so that a trial does not allocate
  Integrator* active_;
  bool is_started_ = false, is_warm_ = false;
  int count_ = 0;
  double explicit_step_ = 0.0; ///< longest explicit step allowed by stability, s
  double suspicious_share_;
  double mean_share_ = 0.0, mean_step_ = 0.0; ///< averages over explicit steps; mean_step_ in s
  /// Number of explicit steps since the explicit method was resumed, and number from which the implicit method may be tried.
  long steps_explicit_ = 0, steps_before_trial_ = k_steps_before_trial;
  long steps_before_any_ = k_steps_before_any;
  double last_step_ = 0.0;     ///< length of the previous step, s
  double implicit_step_ = 0.0; ///< implicit step length that the explicit method has to compete with, s; 0: unknown
  bool is_trial_ = false;
  long implicit_steps_before_ = 0;
};

} // namespace

std::unique_ptr<Integrator> make_automatic(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Automatic>(dynamics, settings, max_dimension);
}

} // namespace steplap
