// Explicit until stiffness shows, then implicit, and back.
//
// Explicit: dop853, at tolerances above 1e-5 tsit5. Stiffness shows where the step is as long as stability
// allows, several steps in a row (Integrator::stability_share); Rodas5P goes on from there. After a number
// of implicit steps, or when they have become little longer than what explicit ones could be, the explicit
// method is tried again: being wrong costs it a handful of steps, a few percent of the implicit ones.
//
// At tight tolerances a stiff scene keeps explicit steps well below that bound: what it leaves of the fast motion, rounding
// among it, must be damped below the tolerance within each step. Such steps are known by a share that is far above that of
// an accurate step, on average. Then the implicit method is tried, and keeps its place only where its steps are longer by
// more than what they cost; after each trial in vain the explicit one has twice as many steps before the next. Where the
// implicit method gives way after many steps to see whether the explicit one does better by now, it is known what that has
// to come to.
#include "mbd/base/portable_math.h"
#include "mbd/integrators/methods.h"

#include <algorithm>

namespace steplap {

namespace {

constexpr double k_loose = 1e-5;     // tolerance above which order 5 is cheaper than order 8
constexpr double k_limited = 0.8;    // share of the stability bound that counts as limited by it
constexpr int k_steps_limited = 5;   // in a row (each must be; an accurate step is well below)
constexpr int k_steps_implicit = 60; // before the explicit method is tried again
constexpr double k_worth = 6.0;      // an implicit step costs about as much as so many explicit ones
// Share of an accurate step of dop853 along an oscillation, at a tolerance of 1e-8; it goes as the error's eighth root.
constexpr double k_accurate_share = 0.26;
constexpr double k_suspicious = 2.0;       // times that share, on average: hardly accuracy
constexpr double k_memory = 1.0 / 16.0;    // weight of a step in averages
constexpr int k_steps_before_trial = 32;   // the first time, so that the averages are those of these steps
constexpr long k_most_before_trial = 1024; // a trial in vain costs some 40 explicit steps: 4 % at most
// However accurate its steps look, after so many the explicit method is compared: what an accurate share is, is known of
// oscillations alone. After each trial in vain it has four times as many, so that all of them together cost a few percent of a long run.
constexpr long k_steps_before_any = 128;
constexpr int k_steps_to_grow = 8; // of a method taken up again: steps grow sixfold each
constexpr double k_grows = 1.2;    // from step to step: a trial behind an event begins with short ones

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
  [[nodiscard]] WatchNodes& watch_nodes() override { return active_->watch_nodes(); }
  void expect_looks(bool are_expected) override {
    Integrator::expect_looks(are_expected);
    explicit_->expect_looks(are_expected);
    implicit_->expect_looks(are_expected);
  }
  [[nodiscard]] bool bears_look(Dynamics& dynamics) override {
    const bool bears = active_->bears_look(dynamics);
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

  void step(Dynamics& dynamics, double t_limit) override { step_by_parts(dynamics, t_limit); }

  void begin_step(Dynamics& dynamics, double t_limit) override {
    choose(dynamics);
    if (!is_started_) active_->restart(dynamics, t0_, y0_.data());
    is_started_ = true;
    active_->begin_step(dynamics, t_limit);
  }

  void make_try(Dynamics& dynamics) override { active_->make_try(dynamics); }

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
  }

  // Counts what speaks for the other method; the change itself waits until the step has been used.
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

  // Is the explicit method slower than accuracy asks for? Then its pace is what the implicit one has to beat.
  [[nodiscard]] bool is_trial_due() const {
    if (steps_explicit_ >= k_steps_to_grow && k_worth * h_ < implicit_step_ && k_worth * mean_step_ < implicit_step_) return true;
    if (steps_explicit_ >= steps_before_any_ && mean_share_ > 0.5 * suspicious_share_) return true;
    return steps_explicit_ >= steps_before_trial_ && mean_share_ > suspicious_share_;
  }

  void choose(Dynamics& dynamics) {
    const bool is_explicit = active_ == explicit_.get();
    // What is stiff about a slip law comes and goes with its speed, and is over before a trial pays.
    const bool is_trial = is_explicit && count_ < k_steps_limited && is_trial_due() && !(dynamics.slip_decay_rate() > 0.0);
    if (count_ < (is_explicit ? k_steps_limited : k_steps_implicit) && !is_trial) return;
    count_ = 0;
    is_started_ = false;
    if (!is_explicit) {
      const bool is_in_vain = implicit_->steps() - implicit_steps_before_ < k_steps_implicit / 2; // a handful of steps
      if (is_trial_) steps_before_trial_ = is_in_vain ? std::min(2 * steps_before_trial_, k_most_before_trial) : k_steps_before_trial;
      if (is_trial_) steps_before_any_ = is_in_vain ? 4 * steps_before_any_ : k_steps_before_any;
      implicit_step_ = is_in_vain ? 0.0 : h_;
      active_ = explicit_.get();
      steps_explicit_ = 0;
      return;
    }
    is_trial_ = is_trial;
    if (is_trial) explicit_step_ = mean_step_;
    if (implicit_->steps() == 0) implicit_->propose_step(10.0 * explicit_step_); // what the explicit one has made, ten times
    active_ = implicit_.get();
    implicit_steps_before_ = implicit_->steps();
  }

  std::vector<double> k_;
  std::unique_ptr<Integrator> explicit_, implicit_; ///< both from the start: a trial may come in any step, which allocates nothing
  Integrator* active_;
  bool is_started_ = false, is_warm_ = false;
  int count_ = 0;
  double explicit_step_ = 0.0; ///< the longest that stability allows, or in a trial what the method came to, s
  double suspicious_share_;
  double mean_share_ = 0.0, mean_step_ = 0.0;                           ///< of explicit steps; s
  long steps_explicit_ = 0, steps_before_trial_ = k_steps_before_trial; ///< since the method was taken up again
  long steps_before_any_ = k_steps_before_any;
  double last_step_ = 0.0;     ///< s
  double implicit_step_ = 0.0; ///< that the explicit method has to beat, s; 0: none known
  bool is_trial_ = false;
  long implicit_steps_before_ = 0;
};

} // namespace

std::unique_ptr<Integrator> make_automatic(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension) {
  return std::make_unique<Automatic>(dynamics, settings, max_dimension);
}

} // namespace steplap
