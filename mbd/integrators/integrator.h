// The interface behind which every one-step method sits.
//
// A method advances the packed vector y of a Dynamics within one mode; it knows nothing of events. It
// leaves the step it has made (both ends, rates, watch values, dense output) for whoever looks for
// events in it, and goes on from where it is told: accept() from the step's end, restart() from
// anywhere (after an event, in a new layout).
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/integrators/singular_crossing.h"
#include "mbd/integrators/turn_limit.h"
#include "mbd/integrators/watch_nodes.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace steplap {

struct IntegratorSettings {
  double tolerance = 1e-8; ///< relative local error of adaptive methods
  double step = 0.0;       ///< s; fixed-step methods need it, others take it as the first step
  double max_step = 0.0;   ///< s; 0: none
  double projection_tolerance = 1e-12;
  /// Of a finer run, above 1: whatever else limits a step (a breakpoint, a harmonic, the forces behind an event, a slip that
  /// ends) limits one of so many parts. Fixed steps are cut as steps of division × step would be, and then divided.
  int division = 1;
};

class Integrator {
public:
  Integrator(const Dynamics& dynamics, const IntegratorSettings& settings, int max_dimension);
  virtual ~Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;

  [[nodiscard]] virtual const char* name() const = 0;
  [[nodiscard]] virtual bool is_adaptive() const = 0;
  /// Begins at (t, y) in the layout that `dynamics` has now; evaluates the rates there.
  void restart(Dynamics& dynamics, double t, const double* y);
  /// The same where `dynamics` was evaluated there last, merged joints watched, and found the rates `dy`.
  void restart_evaluated(Dynamics& dynamics, double t, const double* y, const double* dy);
  /// Will somebody look into every step (samples, extremes)? Then, and unless told otherwise, step() makes none whose dense
  /// output is worse than its ends allow; if not, bears_look() tells.
  virtual void expect_looks(bool are_expected) { are_looks_expected_ = are_expected; }
  /// To be asked before anybody looks into the step made. False: its dense output is worse than its ends allow; the step is
  /// withdrawn, and step() makes another, shorter one.
  [[nodiscard]] virtual bool bears_look(Dynamics& /*dynamics*/) { return true; }
  /// To be asked where the step made is to be used up to: at theta of it, in the state y. False: some slip has fallen there to
  /// what velocities are known to in this step, so that nobody could tell whether it comes to rest or which way it goes on;
  /// the step is withdrawn, and step() makes another, shorter one.
  [[nodiscard]] virtual bool resolves_slips(Dynamics& dynamics, double theta, const double* y);
  /// The share of the step made in which bodies turn no further than they may (turn_limit.h); 1: all of it.
  [[nodiscard]] double turns_kept(const Dynamics& dynamics) { return turn_limit_.kept(dynamics.layout(), y0_.data(), y1_.data()); }
  /// Takes the step made back, so that step() makes one of this share of it. False: it has to stay as it is.
  [[nodiscard]] virtual bool shorten(Dynamics& dynamics, double share) { return withdraw(dynamics, share * h_); }
  /// No step is longer than this, s: Simulation sets it anew wherever the loads' and drives' harmonics change.
  virtual void limit_step(double longest) { longest_step_ = longest; }
  /// Takes the memory that its steps will need, at (t, y) in the present layout: afterwards they allocate nothing.
  virtual void reserve(Dynamics&, double, const double*) {}
  /// The length of the next step, s, of a method that chooses its steps and has made none yet.
  virtual void propose_step(double) {}
  /// No step turns a harmonic of a load or drive further than this, rad: its places resolve a quarter of a period.
  static constexpr double k_largest_turn = 1.6;
  /// Makes one step of at most t_limit − t. Throws NumericalFailure where no step can be made.
  virtual void step(Dynamics& dynamics, double t_limit) = 0;
  /// The same in parts, so that a step whose events forbid it can be tried anew: begin_step(), then make_try() and conclude_try()
  /// in turn until the step is made. A method without tries makes its step in the last.
  virtual void begin_step(Dynamics& dynamics, double t_limit);
  virtual void make_try(Dynamics& dynamics);
  [[nodiscard]] virtual bool conclude_try(Dynamics& dynamics);
  /// Ends the step just made at theta of it, anew as a step of its own. Fixed steps do where forces have a kink behind
  /// the event; no error estimate has shortened them. False: it was left as it is.
  virtual bool end_at(Dynamics& dynamics, double theta);
  /// Nobody will look beyond theta of the step made, where an event ends it: dissipated energy and work are to be as exact
  /// there as at an end. May evaluate.
  virtual void cut_at(Dynamics& /*dynamics*/, double /*theta*/) {}
  /// State at t + theta·h of the step made, 0 ≤ theta ≤ 1. May evaluate.
  virtual void dense(Dynamics& dynamics, double theta, double* out) = 0;
  /// Goes on from the end of the step.
  virtual void accept();
  /// Of an explicit method: h times the fastest rate met, over what the method bears; above 1 stability
  /// and not accuracy limits the step. 0: not known.
  [[nodiscard]] virtual double stability_share(Dynamics& /*dynamics*/) { return 0.0; }
  /// Of a method that locates no events but decides contact modes and friction phases itself: the state at
  /// the end of the step, which `dynamics` then has; null for all others.
  [[nodiscard]] virtual const State* stepped_state() const { return nullptr; }

  // --- the step made ------------------------------------------------------------------------------
  [[nodiscard]] double t0() const { return t0_; }
  [[nodiscard]] double h() const { return h_; }
  [[nodiscard]] double t1() const { return t1_; }
  [[nodiscard]] const double* y0() const { return y0_.data(); }
  [[nodiscard]] const double* y1() const { return y1_.data(); }
  [[nodiscard]] const double* rate0() const { return k0_; }
  [[nodiscard]] const double* rate1() const { return k1_; }
  [[nodiscard]] const std::vector<double>& watch0() const { return watch0_; }
  [[nodiscard]] const std::vector<double>& watch1() const { return watch1_; }
  [[nodiscard]] const std::vector<double>& watch_rate0() const { return watch_rate0_; }
  [[nodiscard]] const std::vector<double>& watch_rate1() const { return watch_rate1_; }
  /// Watch values met at the stages inside the step.
  [[nodiscard]] virtual WatchNodes& watch_nodes() { return nodes_; }

  /// Relative local error asked for; 0 of methods that do not choose their steps.
  [[nodiscard]] double tolerance() const { return is_adaptive() ? settings_.tolerance : 0.0; }
  /// How well velocities are known in the step made, m/s: its tolerance, or their rounding.
  [[nodiscard]] double rate_accuracy(const Dynamics& dynamics) const;
  /// The same of places, m, and of angles, rad.
  [[nodiscard]] double place_accuracy(const Dynamics& dynamics) const;
  /// Fixed steps that were divided, since bodies turned too far in them.
  struct DividedSteps {
    long count = 0;
    double shortest = std::numeric_limits<double>::infinity(); ///< s
    int a = k_ground, b = k_ground;                            ///< which turned fastest against each other
  };
  [[nodiscard]] const DividedSteps& divided_steps() const { return divided_; }
  [[nodiscard]] long steps() const { return steps_; }
  [[nodiscard]] long rejections() const { return rejections_; }
  [[nodiscard]] double max_position_residual() const { return residual_.position; }
  [[nodiscard]] double max_velocity_residual() const { return residual_.velocity; }

protected:
  virtual void on_restart(Dynamics& /*dynamics*/) {}
  /// Takes the step made back; the next one tries h. False: it has to stay as it is.
  [[nodiscard]] virtual bool withdraw(Dynamics& /*dynamics*/, double /*h*/) { return false; }
  [[nodiscard]] bool are_looks_expected() const { return are_looks_expected_; }
  void begin_at(Dynamics& dynamics, double t, const double* y);
  void note_begin(Dynamics& dynamics);
  /// Where the rates at both ends are kept; a method with more stages points them into its own.
  void set_rate_storage(double* k0, double* k1) {
    k0_ = k0;
    k1_ = k1;
  }
  /// Projects y1 and evaluates there: rates into k1, watch values into watch1.
  void finish_step(Dynamics& dynamics);
  /// False where the end cannot be brought onto the constraints: a shorter step may (friction that holds up to an event
  /// early in the step would have to turn a body far beyond it).
  [[nodiscard]] bool try_finish_step(Dynamics& dynamics);
  /// At the last evaluation: how fine velocities have to be known there.
  void note_slips(Dynamics& dynamics, std::vector<double>& scale, bool& is_any);
  void begin_watch_nodes() {
    nodes_.clear();
    last_merged_look_ = 0.0;
  }
  /// Rates of a stage at t0 + theta·h, and its watch values.
  void evaluate_stage(Dynamics& dynamics, double t, const double* y, double* dy, double theta);
  [[nodiscard]] bool is_merged_look_due(double theta) const;
  /// After the rates dy of a stage at t0 + theta·h.
  void note_stage_watches(Dynamics& dynamics, const double* dy, double theta);
  /// `h` within the limits set.
  [[nodiscard]] double limited(double h) const {
    if (settings_.max_step > 0.0) h = std::min(h, settings_.max_step);
    return std::min(h, longest_step_);
  }
  /// Limits the next step by the angle that bodies may turn in it. `division`: into so many parts as in TurnLimit.
  [[nodiscard]] double limited_by_turns(const Dynamics& dynamics, double h, int division) {
    return turn_limit_.longest(dynamics.layout(), y0_.data(), k0_, h, division);
  }
  /// Counts a fixed step that became shorter than what was asked for, since it would have turned bodies too far.
  void note_divided(double h);
  /// Weights of the error norm: 1/(tolerance · scale) per coordinate, 0 where locked.
  void update_weights(Dynamics& dynamics);
  [[nodiscard]] double error_norm(const double* error) const;
  /// The same without most of what the projection will take away, near singular positions of the joints.
  /// A share stays: the directions turn within a step. Changes `error`; the last evaluation must have been
  /// near the step's end.
  [[nodiscard]] double projected_error_norm(Dynamics& dynamics, double* error) const;
  [[nodiscard]] double first_step(Dynamics& dynamics, int order, double h_max);
  /// The step of h_ from t0_ for a crossing of a singular position.
  [[nodiscard]] SingularCrossing::Step crossing_step(Dynamics& dynamics);
  /// step() by its parts.
  void step_by_parts(Dynamics& dynamics, double t_limit);
  /// h, or as much of it as the forces of the present modes allow without stopping and turning the motion: what
  /// limited the steps before an event knew nothing of them. After update_weights.
  [[nodiscard]] double restrained_step(Dynamics& dynamics, double h);

  const System& system_;
  IntegratorSettings settings_;
  int n_ = 0;                 ///< dimension now
  bool is_restarted_ = false; ///< no step was made since
  bool are_looks_expected_ = true;
  double t0_ = 0.0, t1_ = 0.0, h_ = 0.0;
  double t_limit_ = 0.0; ///< of begin_step()
  std::vector<double> y0_, y1_, weight_, scratch_;
  double* k0_ = nullptr;
  double* k1_ = nullptr;
  std::vector<double> watch0_, watch1_, watch_rate0_, watch_rate1_;
  WatchNodes nodes_;
  double longest_step_ = std::numeric_limits<double>::infinity();
  TurnLimit turn_limit_;
  DividedSteps divided_;
  double last_merged_look_ = 0.0;                 ///< theta at which joints that are merged were last looked at inside the step
  std::vector<double> slip_scale0_, slip_scale1_; ///< per rate, then speeds (Dynamics::slip_scales)
  std::vector<double> slip_scale_inside_;         ///< where the step is used up to
  bool has_slip_scale0_ = false, has_slip_scale1_ = false;
  double slip_care_ = 1.0;  ///< of the errors that velocities of a slip may have: less where nothing checks the output within a step
  double decay_rate_ = 0.0; ///< of slip laws where the next step begins, 1/s; of methods that choose no steps
  long steps_ = 0, rejections_ = 0;
  Residual residual_;
  double length_scale_ = 1.0;
  double rate_floor_ = 1.0; ///< 1/s: of what is too small for errors relative to it
};

/// One of methods() (mbd/model/method.h). Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::unique_ptr<Integrator> make_integrator(const std::string& name, const Dynamics& dynamics,
                                                          const IntegratorSettings& settings);

} // namespace steplap
