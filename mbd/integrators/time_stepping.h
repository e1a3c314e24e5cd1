// Time stepping after Moreau and Jean: forces as impulses over a fixed step, laws met at the step's
// end.
//
//   M (v₁ − v₀) = h (Q(q₁, v₁, t₁) + Jᵀλ₁ + Hᵀw),   q₁ = q₀ + h v₁,   J v₁ = target's rate,
//   −H v₁ in the normal cone of K at w: each friction element bears any w inside its convex set K
//   and slides only on the set's boundary, the way that dissipates most.
// Forces that follow signals enter by their means over the step, from the signals' integrals: their impulse is exact however
// short they are. What moves by a signal does so by its value at the step's end, where what it presses against is met:
// steps have to resolve it (Moreau, Simulation).
// Springs, dampers and contacts enter linearised at the step's begin (linearization.h) and
// implicitly, so that no stiffness limits the step; which contacts press is found by repeating the
// step until the pressed ones are those that the end asks for. Friction is the convex problem of
// friction_modes.h with velocities in place of accelerations, solved by block Gauss–Seidel over the
// elements. Its operator, the change of H v₁ by w, is the one that joints and drives leave: they
// answer every w within the step. The free velocities H v₁ are those of the step's end, on the
// constraints, and so are the normal forces: both are found by repetition.
//
// First order; no event is located: chattering, simultaneous impacts and jumps cost little more
// than smooth motion. Vibrations of period T are damped by 2π²h/T of their amplitude in each period
// (implicit Euler). Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom
// dynamics (CISM 302, 1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235.
//
// Friction that changes the normal force it hangs on by more than itself (a ladder whose foot jams)
// does not settle so: there each element is solved with its bound as a function of its wrench,
// linear at where the repetition is (Newton).
//
// A step is made only if it is consistent: friction and normal forces settled, contact modes those
// that its end asks for. Where they are not (a contact's damper makes its force jump on closing:
// within a step that is long against m/c neither mode is right) the step is halved, where both have
// an answer, down to a millionth; a run in which that does not help stops.
//
// What sticks at a step's end may slip inside the step: the mean of a load leaves its peak out, and so does a clamping pressure
// that is read at the end. A step in which that is so is halved, too (inner_slips.cpp).
#pragma once

#include "mbd/integrators/stage_system.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace steplap {

class TimeStepping {
public:
  explicit TimeStepping(const System& system);

  /// Called at the end of each part that a step is made of, with the states at its ends.
  using PartObserver = std::function<void(const State& before, const State& after)>;

  /// Advances `state` by h to its time t1 = t + h, with contact modes, friction phases, anchors,
  /// and the two integrals of power. `dynamics` is left with `state` set. Locks and rows are met to
  /// `tolerance`. A step whose length is rounding decides nothing. Throws NumericalFailure, `state`
  /// then being that before the part of the step that cannot be made.
  void step(Dynamics& dynamics, State& state, double t1, double tolerance, const PartObserver& observe = {});

  /// Time stands still (settling.h): in steps that follow loads, drives and clamping pressures are those of `t`, whatever the step's times.
  void hold_time(double t) { held_time_ = t; }
  /// Largest residuals met before projection in the last step.
  [[nodiscard]] const Residual& residual() const { return residual_; }
  /// Parts into which steps were halved so far, beyond one for each step.
  [[nodiscard]] long extra_parts() const { return extra_parts_; }

private:
  struct FrictionPart {
    int friction = 0, first = 0, dimension = 0; ///< first: among the rows of all parts
    bool has_slid = false;                      ///< at the end of the step before
    bool is_kinetic = false;                    ///< its set is that of the kinetic coefficient
    bool is_returned = false;                   ///< was given back its static coefficient in this step
    bool is_loaded = false;                     ///< it can bear something
    bool is_driven = false;                     ///< some direction that joints and drives alone decide
    Mat3 mobility = Mat3::Zero();               ///< of such a part: its own block, exact zeros along those directions
    Mat3 free = Mat3::Identity();               ///< projector along the others
    double noise = 0.0;                         ///< velocity along those directions that counts as rest
    double bound = 0.0, kinetic_share = 1.0;    ///< of one dimension: what it bears at bound_at_, and sliding, of that
    FrictionBlock block;
  };
  /// Gradient of a friction row in the coordinates of the clusters of its two sides.
  struct FrictionGradient {
    int cluster[2] = {-1, -1};
    double g[2][3] = {};
  };
  /// Why a step could not be made.
  struct Trouble {
    const char* what = nullptr; ///< null: it could
    int element = -1;
    double residual = 0.0;
    const char* unit = "";
  };

  /// An element that sticks, at the end of a part.
  struct Sticking {
    double t = -1.0;      ///< s, of that end; negative: it does not stick
    double usage = 0.0;   ///< share of what it bears
    double change = 0.0;  ///< of that since the part before; 1 where nothing is known of it
    bool is_near = false; ///< inside the part usage may have been one
  };
  static constexpr int k_glances = 3;

  /// At which loads, drives and pressures are taken, at t of a step.
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
  void finish_phases(Dynamics& dynamics, State& state, double h);
  void book_power(Dynamics& dynamics, State& state, double h);
  // inner_slips.cpp
  [[nodiscard]] bool note_sticking(Dynamics& dynamics, double t1);
  [[nodiscard]] bool slips_inside(Dynamics& dynamics, double t1, double tolerance);
  [[nodiscard]] double usage_of(const Evaluation& e, const FrictionPart& part) const;
  // time_stepping_friction.cpp
  void collect_friction(Dynamics& dynamics, State& state);
  [[nodiscard]] bool has_held(const FrictionState& friction, int f) const;
  void load_row(Dynamics& dynamics, const RowSpec& spec, FrictionGradient& row) const;
  void respond(Dynamics& dynamics, double h);
  void find_driven(FrictionPart& part, double h);
  void free_rates(Dynamics& dynamics, double tolerance);
  [[nodiscard]] Trouble settle_wrenches(Dynamics& dynamics, double& change);
  [[nodiscard]] double sweep(Dynamics& dynamics, int& worst);
  [[nodiscard]] FrictionBlock solve_part(const Evaluation& e, const FrictionPart& part) const;
  [[nodiscard]] FrictionBlock solve_coupled(const FrictionPart& part, double a, double b) const;
  [[nodiscard]] double bound_of(const Evaluation& e, const FrictionPart& part, bool is_kinetic) const;
  void couple_bounds(Dynamics& dynamics, double t1, double tolerance);
  void find_slope(Dynamics& dynamics, double t1, const FrictionPart& by);
  [[nodiscard]] double change_of(const FrictionPart& part, const double* before, double size) const;
  [[nodiscard]] double size_of(const FrictionPart& part, const double* wrench) const;
  [[nodiscard]] double largest_size(const Evaluation& e) const;
  void hold_together();
  [[nodiscard]] bool hold_rows();
  [[nodiscard]] bool factor_held(double proximal);
  [[nodiscard]] double solve_held(int steps);
  void stretch(const Evaluation& e);
  [[nodiscard]] bool bears(const Evaluation& e, double share) const;
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
  std::vector<double> start_watch_, start_watch_rate_; ///< of the part being made
  double longest_ = 0.0;                               ///< step so far, s
  long extra_parts_ = 0;
  std::vector<FrictionPart> parts_;
  int n_ = 0, rows_ = 0;
  std::vector<double> y0_, y1_, dy_, right_, free_, probe_;
  std::vector<FrictionGradient> gradient_; ///< per friction row
  std::vector<double> response_;           ///< rows × 2n: change of state by a unit force
  std::vector<double> compliance_;         ///< rows × rows: change of a row's rate by a unit force along another
  std::vector<double> rate_;               ///< per row: rate at the end without wrenches
  std::vector<double> wrench_, before_,
      last_;                                ///< per row: now, before the last repetition, before the last sweep
  bool is_coupled_ = false;                 ///< bounds as functions of the wrenches
  std::vector<double> bound_at_, bound_by_; ///< per row: the wrench there; rows × rows: ∂bound/∂wrench
  std::vector<int> held_;                   ///< rows of factor_held() and solve_held()
  std::vector<char> tried_;                 ///< per set of modes tried and part: was it kinetic?
  std::vector<double> overload_;            ///< per part: share of its static set that it would need to hold
  std::vector<double> matrix_, together_, rest_;
  std::vector<Sticking> sticking_, sticking_now_;               ///< per friction element: of the part before, of the part made
  std::vector<std::array<double, k_glances>> glance_usage_;     ///< per friction element
  double held_time_ = std::numeric_limits<double>::quiet_NaN(); ///< s; not-a-number: time goes on
  double glance_ = 0.0; ///< s: loads are taken by their means over so long before the part's end; 0: over the part
};

} // namespace steplap
