// Time stepping after Moreau and Jean: impulses over a fixed step, with the laws satisfied at its end.
//
//   M (v₁ − v₀) = h (Q(q₁, v₁, t₁) + Jᵀλ₁ + Hᵀw),   q₁ = q₀ + h v₁,   J v₁ = prescribed rate,
//   −H v₁ in the normal cone of K at w: each friction element can have any w in its convex set K, and slides only on the boundary of K,
//   in the direction of maximum dissipation.
//
// Forces that are signals enter by their means over the step, so that the impulse of a short pulse is exact. Signals used in other ways
// (drives, parameters) enter by their value at the end of the step, and steps must resolve them (Moreau, Simulation).
//
// Springs, dampers and contacts are linearised at the start of the step (linearization.h) and treated implicitly, so that stiffness does
// not limit the step. The step is repeated until the set of pressed contacts assumed in it agrees with the one at its end. Friction is
// the convex problem of friction_modes.h with velocities in place of accelerations, solved by block Gauss–Seidel iteration over the
// elements. Its matrix, the change of H v₁ by w, includes the reactions of joints and drives. The velocities H v₁ without friction, and
// the normal forces, are those of the projected end of the step, and are iterated as well.
//
// The method is of first order. Events are not located: chattering, simultaneous impacts and jumps cost little more than smooth motion.
// Vibrations of period T lose 2π²h/T of their amplitude per period (implicit Euler). Source: J. J. Moreau, Unilateral contact and dry
// friction in finite freedom dynamics (CISM 302, 1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235.
//
// The plain iteration diverges if friction changes its own normal force by more than its own amount (a ladder whose foot jams). Each
// element is then solved with its bound as a linear function of its wrench (Newton's method).
//
// A step is accepted only if friction and normal forces have converged and contact modes agree with its end. Otherwise it is halved, down
// to a millionth. (Example: the damper of a closing contact makes the force jump; if the step is long compared with m/c neither mode is
// consistent.) A contact for which neither mode is consistent, and which would close late in the step, closes at its end instead. If
// halving does not help the run stops.
//
// As an integrator (moreau.cpp) time stepping lets contacts rebound that close with a velocity: the mean force of a step in an impact is the
// one whose work is the change of the stored energy (contact_impacts.h).
//
// A friction element that sticks at the end of a step may have slipped within it, because means of loads and the clamping pressure at the
// end do not show peaks. Such steps are halved, too (inner_slips.cpp). One that lands with a velocity along its row and sticks at the end
// of that step has slipped in any case: its slip is reported, and the step is not halved for it. Nor is it for one in an impact.
#pragma once

#include "mbd/integrators/contact_impacts.h"
#include "mbd/integrators/row_compliance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace steplap {

/// Time stepping of one system; see Moreau (moreau.cpp) for its use as an integrator.
class TimeStepping {
public:
  explicit TimeStepping(const System& system);

  /// Called for each part of a step with the states at its ends.
  using PartObserver = std::function<void(const State& before, const State& after)>;

  /// Advances `state` to the time t1, s: motion, contact modes, friction phases, anchors, and the integrals of power. `dynamics` is left
  /// set to `state`. Constraints are satisfied to `tolerance`, m, rad. If the length of the step is only rounding, modes do not change.
  /// Throws NumericalFailure if a part of the step cannot be made; `state` is then that before this part.
  void step(Dynamics& dynamics, State& state, double t1, double tolerance, const PartObserver& observe = {});

  /// Stops time at `t` for loads, drives and clamping pressures in all following steps (settling.h). `keeps_sliding`: what slid in the last
  /// step keeps its kinetic coefficient until it stops, as in a run; otherwise each step starts with the static one.
  void hold_time(double t, bool keeps_sliding) {
    held_time_ = t;
    keeps_sliding_ = keeps_sliding;
  }
  /// Lets contacts rebound that close with a velocity (contact_impacts.h). Without this call their vibrations are damped as all others.
  void resolve_impacts() { impacts_ = ContactImpacts(system_); }
  /// Returns the largest constraint residuals before projection in the last step.
  [[nodiscard]] const Residual& residual() const { return residual_; }
  /// Returns the number of parts added by halving, in all steps so far.
  [[nodiscard]] long extra_parts() const { return extra_parts_; }

private:
  /// A friction element that may carry a load, in the present part of a step.
  struct FrictionPart {
    int friction = 0, first = 0, dimension = 0; ///< first: index of its first row
    bool has_slid = false;                      ///< the element slid at the end of the previous step
    bool has_landed = false;                    ///< nothing pressed on it at the end of the previous step
    double landing_rate[3] = {};                ///< if it has landed: rates of its rows at the start of the part
    bool is_kinetic = false;                    ///< the kinetic coefficient is used
    bool is_returned = false;                   ///< the element has got back its static coefficient in this step
    bool is_loaded = false;                     ///< the admissible set of wrenches is larger than {0}
    bool is_driven = false;                     ///< in some direction joints and drives alone determine the velocity
    Mat3 mobility = Mat3::Zero();               ///< if driven: the element's block of the mobility, zero in the driven directions
    Mat3 free = Mat3::Identity();               ///< if driven: projection onto the directions that are not driven
    double noise = 0.0;                         ///< velocity in driven directions that counts as rest, m/s or rad/s
    double own[9] = {};                         ///< compliance of the element's rows, dimension × dimension
    /// For dimension 1: bound, N, at the wrench bound_at_; ratio of the kinetic to the static bound.
    double bound = 0.0, kinetic_share = 1.0;
    BlockSolution block;

    [[nodiscard]] double compliance(int i) const { return own[i * (dimension + 1)]; } ///< diagonal entry for row i
  };
  /// Reason why a step cannot be made.
  struct StepFailure {
    const char* what = nullptr; ///< text; null: the step is possible
    int element = -1;
    double residual = 0.0;
    const char* unit = "";
  };

  /// A sticking element at the end of a part.
  struct Sticking {
    double t = -1.0;      ///< end of the part, s; negative: the element does not stick
    double usage = 0.0;   ///< utilisation: load relative to the capacity
    double change = 0.0;  ///< change of the utilisation from the previous part; 1 if unknown
    bool is_near = false; ///< the utilisation may have reached one within the part
  };
  static constexpr int k_glances = 3;

  /// Returns the time for which loads, drives and pressures are evaluated in a step at t.
  [[nodiscard]] double time_of_loads(double t) const { return std::isnan(held_time_) ? t : held_time_; }
  [[nodiscard]] bool is_rounding(double t0, double t1) const;
  void drift(Dynamics& dynamics, State& state, double t1);
  [[nodiscard]] StepFailure try_part(Dynamics& dynamics, State& state, double t1, double tolerance);
  [[nodiscard]] StepFailure settle_forces(Dynamics& dynamics, double t1, double tolerance);
  void evaluate(Dynamics& dynamics, double t, const double* y);
  void move(Dynamics& dynamics, double t1, double tolerance);
  [[noreturn]] void fail(const StepFailure& trouble, double t, double h) const;
  [[nodiscard]] int changed_unit(Dynamics& dynamics, State& state);
  [[nodiscard]] int passed_unit(const Dynamics& dynamics, const State& state, double h) const;
  [[nodiscard]] bool repeats_modes(const State& state);
  [[nodiscard]] bool only_closes_late(const Dynamics& dynamics, const State& state) const;
  [[nodiscard]] bool slides_at_landing(const FrictionPart& part) const;
  void finish_phases(Dynamics& dynamics, State& state, double h);
  void book_power(Dynamics& dynamics, State& state, double h);
  // defined in inner_slips.cpp
  [[nodiscard]] bool note_sticking(Dynamics& dynamics, double t1);
  [[nodiscard]] bool slips_inside(Dynamics& dynamics, double t1, double tolerance);
  [[nodiscard]] double usage_of(const Evaluation& e, const FrictionPart& part) const;
  // defined in time_stepping_friction.cpp
  void collect_friction(Dynamics& dynamics, State& state);
  [[nodiscard]] bool has_held(const FrictionState& friction, int f) const;
  void load_row(Dynamics& dynamics, const RowSpec& spec, ForceRow& row) const;
  void respond(Dynamics& dynamics, double h);
  void find_driven(FrictionPart& part, double h);
  void rates_without_friction(Dynamics& dynamics, double tolerance);
  [[nodiscard]] StepFailure settle_wrenches(Dynamics& dynamics, double& change);
  [[nodiscard]] double sweep(Dynamics& dynamics, int& worst);
  [[nodiscard]] BlockSolution solve_part(const Evaluation& e, const FrictionPart& part) const;
  [[nodiscard]] BlockSolution solve_coupled(const FrictionPart& part, double a, double b) const;
  [[nodiscard]] double bound_of(const Evaluation& e, const FrictionPart& part, bool is_kinetic) const;
  void couple_bounds(Dynamics& dynamics, double t1, double tolerance);
  void find_slope(Dynamics& dynamics, double t1, const FrictionPart& by);
  [[nodiscard]] double change_of(const FrictionPart& part, const double* before, double size) const;
  [[nodiscard]] double size_of(const FrictionPart& part, const double* wrench) const;
  [[nodiscard]] double largest_size(const Evaluation& e) const;
  void hold_together();
  /// Sets is_held_ for the rows of the elements that `holds` selects. Driven elements are excluded.
  template <class Holds> void hold(const Holds& holds) {
    for (const FrictionPart& part : parts_)
      std::fill_n(is_held_.begin() + part.first, part.dimension, !part.is_driven && holds(part) ? 1 : 0);
  }
  [[nodiscard]] bool hold_rows();
  [[nodiscard]] bool factor_held(double proximal);
  [[nodiscard]] double solve_held(int steps);
  void stretch(const Evaluation& e);
  [[nodiscard]] bool bears(const Evaluation& e, double share) const;
  [[nodiscard]] double effect_of_others(const FrictionPart& part) const;
  void stop_at_rest(double change);
  // defined in time_stepping_modes.cpp
  [[nodiscard]] bool slid_before(int f) const;
  [[nodiscard]] StepFailure balance_friction(Dynamics& dynamics, bool keeps_kinetic);
  [[nodiscard]] bool turns_round(const FrictionPart& part) const;
  [[nodiscard]] bool return_turned();
  void return_stopped(const Evaluation& e);
  [[nodiscard]] bool give_kinetic(const Evaluation& e, double change);
  [[nodiscard]] bool is_tried() const;
  void note_tried();
  void find_overloads(const Evaluation& e);
  [[nodiscard]] bool is_held_by_others(const FrictionPart& part);

  const System& system_;
  Linearization linearization_;
  StageSystem stages_;
  ContactImpacts impacts_;
  Residual residual_;
  State start_;
  std::vector<double> start_event_value_, start_event_derivative_; ///< event functions and their rates at the start of the present part
  std::vector<UnitMode> modes_made_;                               ///< modes of all passes of the part being made
  double longest_ = 0.0;                                           ///< longest step so far, s
  long extra_parts_ = 0;
  std::vector<FrictionPart> parts_;
  int n_ = 0, rows_ = 0;
  std::vector<double> y0_, y1_, dy_, right_, free_, probe_;
  std::vector<ForceRow> force_rows_; ///< gradients of the friction rows
  RowCompliance compliance_;
  std::vector<double> response_; ///< change of q and v by the forces along the rows
  std::vector<double> rate_;     ///< per row: rate at the end of the step without friction, m/s or rad/s
  std::vector<double> wrench_, before_,
      last_; ///< per row, N or N m: present value; value before the last pass of settle_forces(); value before the last sweep
  bool keeps_sliding_ = true;               ///< kinetic coefficients last from step to step
  bool is_coupled_ = false;                 ///< bounds are linear functions of the wrenches (couple_bounds())
  std::vector<double> bound_at_, bound_by_; ///< per row: wrench at which bounds were linearised; rows × rows: ∂bound/∂wrench
  std::vector<char> is_held_;               ///< per row: solved simultaneously by hold_rows()
  std::vector<char> tried_;                 ///< tried sets of coefficients, one after the other; per element: is the coefficient kinetic?
  std::vector<double> overload_;            ///< per element: wrench needed to stick, relative to the static capacity
  std::vector<double> together_, rest_, softness_; ///< per row: wrenches of hold_rows(); remaining rates; regularisation
  std::vector<Sticking> sticking_, sticking_now_;  ///< per friction element, for the previous and the present part
  /// Per friction element: utilisations at the probed positions (inner_slips.cpp).
  std::vector<std::array<double, k_glances>> glance_usage_;
  double held_time_ = std::numeric_limits<double>::quiet_NaN(); ///< fixed time of loads, s (hold_time()); NaN: none
  double glance_ = 0.0; ///< averaging time of loads before the end of the part, s; 0: the whole part
};

} // namespace steplap
