// Interface of all one-step integration methods.
//
// A method advances the packed state y of a Dynamics within one mode and does not know about events. After a step it provides both ends,
// rates, event functions and dense output to the event finder. It continues from the end of the step by accept(), or from another state by
// restart() (after an event, in a new layout).
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/integrators/event_nodes.h"
#include "mbd/integrators/integrator_settings.h"
#include "mbd/integrators/rate_rounding.h"
#include "mbd/integrators/singular_crossing.h"
#include "mbd/integrators/turn_limit.h"
#include "mbd/system/element_failure.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

class Integrator {
public:
  Integrator(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension);
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  [[nodiscard]] virtual const char* name() const = 0;
  [[nodiscard]] virtual bool is_adaptive() const = 0;
  /// Starts at (t, y) in the present layout of `dynamics` and evaluates the rates there.
  void restart(Dynamics& dynamics, double t, const double* y);
  /// As restart(), but without evaluation. Precondition: the last evaluation of `dynamics` was at (t, y), included event functions of
  /// joints inside clusters, and gave the rates `dy`.
  void restart_evaluated(Dynamics& dynamics, double t, const double* y, const double* dy);
  /// Sets whether every step will be evaluated inside (samples, extremes; the default). If so, step() accepts only steps whose dense
  /// output is as accurate as their ends. If not, dense_output_is_accurate() checks this on demand.
  virtual void expect_dense_evaluations(bool are_expected) { are_dense_evaluations_expected_ = are_expected; }
  /// To be called before the dense output of a step is used for the first time. Returns false if it is less accurate than the ends of the
  /// step; the step is then withdrawn, and step() must be called again to make a shorter one.
  [[nodiscard]] virtual bool dense_output_is_accurate(Dynamics& /*dynamics*/) { return true; }
  /// To be called if only the part of the step up to theta is used, with y the state there. Returns false if a slip velocity has
  /// decreased there to the error of velocities in this step, so that its end or direction would be arbitrary. The step is then
  /// withdrawn, and the next step() makes a shorter one.
  [[nodiscard]] virtual bool resolves_slips(Dynamics& dynamics, double theta, const double* y);
  /// Returns the fraction of the step in which all rotations stay within their limits (turn_limit.h); 1 for the whole step.
  [[nodiscard]] double fraction_within_turn_limits(const Dynamics& dynamics) {
    return turn_limit_.kept(dynamics.layout(), y0_.data(), y1_.data());
  }
  /// Withdraws the last step; the next step() attempts `share` of its length. Returns false if the method cannot withdraw steps.
  [[nodiscard]] virtual bool shorten(Dynamics& dynamics, double share) { return withdraw(dynamics, share * h_); }
  /// Sets an upper limit of the step length, s. Simulation updates it whenever the harmonics of loads and drives change.
  virtual void limit_step(double longest) { longest_step_ = longest; }
  /// Allocates memory for steps from (t, y) in the present layout, so that step() does not allocate.
  virtual void reserve(Dynamics&, double, const double*) {}
  /// Sets the length of the first step, s, of an adaptive method.
  virtual void propose_step(double) {}
  /// Largest angle by which a harmonic of a load or drive may turn in one step, rad, so that the nodes within the step resolve a quarter of
  /// a period.
  static constexpr double k_largest_turn = 1.6;
  /// Makes one step, at most to t_limit. Throws NumericalFailure if it is impossible.
  virtual void step(Dynamics& dynamics, double t_limit) = 0;
  /// Repeats the last step so that it ends at `theta` of it. Used for fixed steps if forces have a kink after an event, since no error
  /// estimate has shortened them. Returns false if the step was left unchanged.
  virtual bool end_at(Dynamics& dynamics, double theta);
  /// Announces that only the part of the step up to theta is used, because of an event. Dissipated energy and work are then computed
  /// there as accurately as at the end of a step. May evaluate `dynamics`.
  virtual void cut_at(Dynamics& /*dynamics*/, double /*theta*/) {}
  /// Writes the state at t0 + theta·h, 0 ≤ theta ≤ 1, to `out`. May evaluate `dynamics`.
  virtual void dense(Dynamics& dynamics, double theta, double* out) = 0;
  /// Makes the end of the step the start of the next one.
  virtual void accept();
  /// Returns, for explicit methods, h times the fastest rate in the step divided by the method's stability limit. Above 1 the step is
  /// limited by stability, not by accuracy. Returns 0 if unknown.
  [[nodiscard]] virtual double stability_share(Dynamics& /*dynamics*/) { return 0.0; }
  /// Returns the state at the end of the step for methods that determine contact modes and friction phases themselves (time stepping);
  /// `dynamics` is then set to this state. Returns null for all other methods.
  [[nodiscard]] virtual const State* stepped_state() const { return nullptr; }

  // --- results of the last step -------------------------------------------------------------------
  [[nodiscard]] double t0() const { return t0_; }
  [[nodiscard]] double h() const { return h_; }
  [[nodiscard]] double t1() const { return t1_; }
  [[nodiscard]] const double* y0() const { return y0_.data(); }
  [[nodiscard]] const double* y1() const { return y1_.data(); }
  [[nodiscard]] const double* rate0() const { return k0_; }
  [[nodiscard]] const double* rate1() const { return k1_; }
  [[nodiscard]] const std::vector<double>& event_value0() const { return event_value0_; }
  [[nodiscard]] const std::vector<double>& event_value1() const { return event_value1_; }
  [[nodiscard]] const std::vector<double>& event_derivative0() const { return event_derivative0_; }
  [[nodiscard]] const std::vector<double>& event_derivative1() const { return event_derivative1_; }
  /// Returns the event functions at the stages inside the step.
  [[nodiscard]] virtual EventNodes& event_nodes() { return nodes_; }

  /// Returns the relative local tolerance; 0 for methods with fixed steps.
  [[nodiscard]] double tolerance() const { return is_adaptive() ? settings_.tolerance : 0.0; }
  /// Returns the accuracy of velocities in the last step, m/s: given by the tolerance, or by rounding for fixed steps.
  [[nodiscard]] double rate_accuracy(const Dynamics& dynamics) const;
  /// Returns the accuracy of positions, m, and angles, rad, in the last step.
  [[nodiscard]] double place_accuracy(const Dynamics& dynamics) const;
  [[nodiscard]] const DividedSteps& divided_steps() const { return divided_; }
  /// Returns the relative local error to which steps were controlled where rounding is larger than the tolerance, the largest; 0: nowhere.
  [[nodiscard]] double rounded_tolerance() const { return rounded_tolerance_; }
  [[nodiscard]] long steps() const { return steps_; }
  [[nodiscard]] long rejections() const { return rejections_; }
  [[nodiscard]] double max_position_residual() const { return residual_.position; }
  [[nodiscard]] double max_velocity_residual() const { return residual_.velocity; }

protected:
  virtual void on_restart(Dynamics& /*dynamics*/) {}
  /// Withdraws the last step and proposes the length h, s, for the next attempt. Returns false if the method cannot withdraw steps.
  [[nodiscard]] virtual bool withdraw(Dynamics& /*dynamics*/, double /*h*/) { return false; }
  [[nodiscard]] bool are_dense_evaluations_expected() const { return are_dense_evaluations_expected_; }
  void begin_at(Dynamics& dynamics, double t, const double* y);
  void note_rounding();
  void note_begin(Dynamics& dynamics);
  /// Sets where the rates at both ends are stored. Methods with more stages use their own arrays.
  void set_rate_storage(double* k0, double* k1) {
    k0_ = k0;
    k1_ = k1;
  }
  /// Projects y1 onto the constraints and evaluates there: rates to k1, event functions to event_value1_.
  void finish_step(Dynamics& dynamics);
  /// As finish_step(). Returns false if the end cannot be projected; a shorter step may succeed. (Example: friction that would hold only
  /// until an event early in the step turns a body far beyond that event.)
  [[nodiscard]] bool try_finish_step(Dynamics& dynamics);
  /// Stores the accuracy required of slip velocities at the last evaluation (Dynamics::slip_scales).
  void note_slips(Dynamics& dynamics, std::vector<double>& scale, bool& is_any);
  void begin_event_nodes() {
    nodes_.clear();
    last_rigid_joint_evaluation_ = 0.0;
  }
  /// Evaluates a stage at t = t0 + theta·h: rates to dy, event functions to the nodes.
  void evaluate_stage(Dynamics& dynamics, double t, const double* y, double* dy, double theta);
  [[nodiscard]] bool are_rigid_joint_events_due(double theta) const;
  /// Stores the event functions of a stage at t0 + theta·h, after its rates dy were computed.
  void record_stage_events(Dynamics& dynamics, const double* dy, double theta);
  /// Returns `h` limited by max_step and limit_step().
  [[nodiscard]] double limited(double h) const {
    if (settings_.max_step > 0.0) h = std::min(h, settings_.max_step);
    return std::min(h, longest_step_);
  }
  /// Returns `h` limited by the rotation of bodies in the next step. `division`: as in TurnLimit::longest().
  [[nodiscard]] double limited_by_turns(const Dynamics& dynamics, double h, int division) {
    return turn_limit_.longest(dynamics.layout(), y0_.data(), k0_, h, division);
  }
  /// Counts a fixed step that was shortened because of rotations.
  void note_divided(double h);
  /// Updates the weights of the error norm: 1/(tolerance · scale) per number of the state, 0 for locked coordinates.
  void update_weights(Dynamics& dynamics);
  /// Returns the error norm of a step of length h_: a value of at most 1 is within the tolerance, or within rounding (rate_rounding.h).
  [[nodiscard]] double error_norm(const double* error) const;
  /// Returns the error norm. Near singular positions the component of the error that projection removes gets a small weight only,
  /// because the directions of the constraints change within a step. Changes `error`. Precondition: the last evaluation was near the end
  /// of the step.
  [[nodiscard]] double projected_error_norm(Dynamics& dynamics, double* error) const;
  [[nodiscard]] double first_step(Dynamics& dynamics, int order, double h_max);
  /// Calls `evaluate` with a trial state, which may be far off the motion if the step is too long. Returns false if an element fails there:
  /// the step, of length h, s, must then be shorter. Rethrows the failure if it cannot be.
  template <class F> [[nodiscard]] bool try_evaluation(double h, const F& evaluate) const {
    try {
      evaluate();
      return true;
    } catch (const ElementFailure&) {
      if (is_shortest_try(h)) throw;
      return false;
    }
  }
  /// Returns true if no step shorter than h, s, is tried after a failure: the failure itself says more than a message about the step.
  [[nodiscard]] bool is_shortest_try(double h) const;
  /// Throws NumericalFailure if a step of length h, s, would not exceed the rounding errors of time.
  void refuse_shorter_than_rounding(double h) const;
  /// Returns the data of a singular crossing by a step of h_ from t0_.
  [[nodiscard]] SingularCrossing::Step crossing_step(Dynamics& dynamics);
  /// Returns h, or a smaller step if the forces of the present modes would stop or reverse a motion within h. Needed after an event,
  /// because earlier step lengths do not account for new forces. Precondition: update_weights().
  [[nodiscard]] double restrained_step(Dynamics& dynamics, double h);

  const System& system_;
  IntegratorSettings settings_;
  int n_ = 0;                 ///< present dimension of the state
  bool is_restarted_ = false; ///< no step has been made since the last restart
  bool are_dense_evaluations_expected_ = true;
  double t0_ = 0.0, t1_ = 0.0, h_ = 0.0;
  std::vector<double> y0_, y1_, weight_, scratch_;
  double* k0_ = nullptr;
  double* k1_ = nullptr;
  std::vector<double> event_value0_, event_value1_, event_derivative0_, event_derivative1_;
  EventNodes nodes_;
  double longest_step_ = std::numeric_limits<double>::infinity();
  TurnLimit turn_limit_;
  DividedSteps divided_;
  RateRounding rate_rounding_;
  double rounded_tolerance_ = 0.0;
  double last_rigid_joint_evaluation_ = 0.0; ///< theta of the last evaluation of joints inside clusters
  /// Per velocity: speed scale of slip (Dynamics::slip_scales) at the start and the end of the step.
  std::vector<double> slip_scale0_, slip_scale1_;
  std::vector<double> slip_scale_inside_; ///< speed scale of slip at the end of the used part of the step
  bool has_slip_scale0_ = false, has_slip_scale1_ = false;
  double slip_care_ = 1.0; ///< factor on the permitted errors of slip velocities; below 1 for methods whose dense output is not checked
  /// Fastest decay rate of velocity-dependent friction at the start of the next step, 1/s; 0 for adaptive methods.
  double decay_rate_ = 0.0;
  long steps_ = 0, rejections_ = 0;
  Residual residual_;
  double length_scale_ = 1.0;
  double rate_floor_ = 1.0; ///< rate, 1/s, that times a length gives the velocity below which errors are absolute
};

/// Creates the method with this name, one of methods() (mbd/model/method.h). Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dynamics& dynamics,
                                                          const IntegratorSettings& settings);

} // namespace steplap
