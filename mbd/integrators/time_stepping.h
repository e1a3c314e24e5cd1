// Time stepping after Moreau and Jean: impulses over a fixed step, with the laws satisfied at its end.
//
//   M (v₁ − v₀) = h (Q(q₁, v₁, t₁) + Jᵀλ₁ + Hᵀw),   q₁ = q₀ + h v₁,   J v₁ = prescribed rate,
//   −H v₁ in the normal cone of K at w: each friction element can have any w in its convex set K, and slides only on the boundary of K, in
//   the direction of maximum dissipation.
//
// Forces that are signals enter by their means over the step, so that the impulse of a short pulse is exact. Signals used in other ways
// (drives, parameters) enter by their value at the end of the step, and steps must resolve them (Moreau, Simulation).
//
// Springs, dampers and contacts are linearised at the start of the step (linearization.h) and treated implicitly, so that stiffness does
// not limit the step. The set of pressed contacts is found by repeating the step until it agrees with its end. Friction is the convex
// problem of friction_modes.h with velocities in place of accelerations, solved by block Gauss–Seidel iteration over the elements. Its
// matrix, the change of H v₁ by w, includes the reactions of joints and drives. The velocities H v₁ without friction and the normal forces
// belong to the end of the step on the constraints, and are found by repetition, too.
//
// The method is of first order. Events are not located: chattering, simultaneous impacts and jumps cost little more than smooth motion.
// Vibrations of period T lose 2π²h/T of their amplitude per period (implicit Euler). Source: J. J. Moreau, Unilateral contact and dry
// friction in finite freedom dynamics (CISM 302, 1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235.
//
// The repetition diverges if friction changes its own normal force by more than itself (a ladder whose foot jams). There each element is
// solved with its bound as a linear function of its wrench (Newton's method).
//
// A step is accepted only if friction and normal forces have converged and contact modes agree with its end. Otherwise it is halved, down
// to a millionth. (Example: the damper of a closing contact makes the force jump; if the step is long compared with m/c neither mode is
// consistent.) A contact for which neither mode is consistent, and which would close late in the step, closes at its end instead. If halving
// does not help the run stops.
//
// A friction element that sticks at the end of a step may have slipped within it, because means of loads and the clamping pressure at the
// end do not show peaks. Such steps are halved, too (inner_slips.cpp). One that lands with a velocity along its row and sticks at the end
// of that step has slipped in any case: its slip is reported, and the step is not halved for it.
#pragma once

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

  /// Advances `state` to the time t1: motion, contact modes, friction phases, anchors, and the integrals of power. `dynamics` is left with
  /// `state` set. Constraints are satisfied to `tolerance`. If the step is only rounding in length, modes do not change. Throws
  /// NumericalFailure if a part of the step is impossible; `state` is then that before this part.
  void step(Dynamics& dynamics, State& state, double t1, double tolerance, const PartObserver& observe = {});

  /// Stops time at `t` for loads, drives and clamping pressures in all following steps (settling.h).
  void hold_time(double t) { held_time_ = t; }
  /// Returns the largest residuals before projection in the last step.
  [[nodiscard]] const Residual& residual() const { return residual_; }
  /// Returns the number of additional parts by halving, in all steps so far.
  [[nodiscard]] long extra_parts() const { return extra_parts_; }

private:
  /// A friction element that may carry a load, in the present part of a step.
  struct FrictionPart {
    int friction = 0, first = 0, dimension = 0; ///< first: index of its first row
    bool has_slid = false;                      ///< it slid at the end of the previous step
    bool has_landed = false;                    ///< nothing pressed on it at the end of the previous step
    double landing_rate[3] = {};                ///< if it has landed: rates of its rows at the start of the part
    bool is_kinetic = false;                    ///< the kinetic coefficient applies
    bool is_returned = false;                   ///< it has got back its static coefficient in this step
    bool is_loaded = false;                     ///< its admissible set is more than zero
    bool is_driven = false;                     ///< in some direction joints and drives alone determine the velocity
    Mat3 mobility = Mat3::Zero();               ///< if driven: its own block of the mobility, zero in these directions
    Mat3 free = Mat3::Identity();               ///< projection onto the other directions
    double noise = 0.0;                         ///< velocity in these directions that counts as rest
    double own[9] = {};                         ///< compliance of its own rows, dimension × dimension
    double bound = 0.0, kinetic_share = 1.0;    ///< dimension 1: bound at the wrench bound_at_; ratio of the kinetic to the static bound
    BlockSolution block;

    [[nodiscard]] double compliance(int i) const { return own[i * (dimension + 1)]; } ///< along its own row i
  };
  /// Reason why a step is impossible.
  struct Trouble {
    const char* what = nullptr; ///< null: it is possible
    int element = -1;
    double residual = 0.0;
    const char* unit = "";
  };

  /// A sticking element at the end of a part.
  struct Sticking {
    double t = -1.0;      ///< time of that end, s; negative: it does not stick
    double usage = 0.0;   ///< utilisation: share of what it can carry
    double change = 0.0;  ///< change of the utilisation since the previous part; 1 if unknown
    bool is_near = false; ///< the utilisation may have reached one within the part
  };
  static constexpr int k_glances = 3;

  /// Returns the time for which loads, drives and pressures are evaluated in a step at t.
  [[nodiscard]] double time_of_loads(double t) const { return std::isnan(held_time_) ? t : held_time_; }
  [[nodiscard]] bool is_rounding(double t0, double t1) const;
  void drift(Dynamics& dynamics, State& state, double t1);
  [[nodiscard]] Trouble try_part(Dynamics& dynamics, State& state, double t1, double tolerance);
  [[nodiscard]] Trouble settle_forces(Dynamics& dynamics, double t1, double tolerance);
  void evaluate(Dynamics& dynamics, double t, const double* y);
  void move(Dynamics& dynamics, double t1, double tolerance);
  [[noreturn]] void fail(const Trouble& trouble, double t, double h) const;
  [[nodiscard]] int changed_unit(Dynamics& dynamics, State& state);
  [[nodiscard]] int passed_unit(const Dynamics& dynamics, const State& state, double h) const;
  [[nodiscard]] bool repeats_modes(const State& state);
  [[nodiscard]] bool only_closes_late(const Dynamics& dynamics, const State& state) const;
  [[nodiscard]] bool slides_at_landing(const FrictionPart& part) const;
  void finish_phases(Dynamics& dynamics, State& state, double h);
  void book_power(Dynamics& dynamics, State& state, double h);
  // inner_slips.cpp
  [[nodiscard]] bool note_sticking(Dynamics& dynamics, double t1);
  [[nodiscard]] bool slips_inside(Dynamics& dynamics, double t1, double tolerance);
  [[nodiscard]] double usage_of(const Evaluation& e, const FrictionPart& part) const;
  // time_stepping_friction.cpp
  void collect_friction(Dynamics& dynamics, State& state);
  [[nodiscard]] bool has_held(const FrictionState& friction, int f) const;
  void load_row(Dynamics& dynamics, const RowSpec& spec, ForceRow& row) const;
  void respond(Dynamics& dynamics, double h);
  void find_driven(FrictionPart& part, double h);
  void free_rates(Dynamics& dynamics, double tolerance);
  [[nodiscard]] Trouble settle_wrenches(Dynamics& dynamics, double& change);
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
  /// Marks the rows of the elements that can hold and that `holds` selects.
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
  // time_stepping_modes.cpp
  [[nodiscard]] bool slid_before(int f) const;
  [[nodiscard]] Trouble balance_friction(Dynamics& dynamics, bool keeps_kinetic);
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
  Residual residual_;
  State start_;
  std::vector<double> start_event_value_, start_event_derivative_; ///< at the start of the part being made
  std::vector<UnitMode> modes_made_;                               ///< modes of all passes of the part being made
  double longest_ = 0.0;                                           ///< longest step so far, s
  long extra_parts_ = 0;
  std::vector<FrictionPart> parts_;
  int n_ = 0, rows_ = 0;
  std::vector<double> y0_, y1_, dy_, right_, free_, probe_;
  std::vector<ForceRow> force_rows_; ///< of the friction rows
  RowCompliance compliance_;
  std::vector<double> response_; ///< 2n: change of the state by forces along the rows
  std::vector<double> rate_;     ///< per row: rate at the end without friction
  std::vector<double> wrench_, before_,
      last_;                                                    ///< per row: now, before the last repetition, before the last sweep
  bool is_coupled_ = false;                                     ///< bounds are functions of the wrenches
  std::vector<double> bound_at_, bound_by_;                     ///< per row: wrench at the linearisation; rows × rows: ∂bound/∂wrench
  std::vector<char> is_held_;                                   ///< per row: solved together with others by hold_rows()
  std::vector<char> tried_;                                     ///< for each set of modes tried, per part: kinetic or not
  std::vector<double> overload_;                                ///< per part: fraction of its static set that it would need to stick
  std::vector<double> together_, rest_, softness_;              ///< per row
  std::vector<Sticking> sticking_, sticking_now_;               ///< per friction element: of the previous part, of the present one
  std::vector<std::array<double, k_glances>> glance_usage_;     ///< per friction element
  double held_time_ = std::numeric_limits<double>::quiet_NaN(); ///< s; NaN: time is not held
  double glance_ = 0.0; ///< duration before the end of the part over which loads are averaged, s; 0: the whole part
};

} // namespace steplap
