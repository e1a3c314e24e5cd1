// Time stepping after Moreau and Jean: forces as impulses over a fixed step, laws met at the step's end.
//
//   M (v₁ − v₀) = h (Q(q₁, v₁, t₁) + Jᵀλ₁ + Hᵀw),   q₁ = q₀ + h v₁,   J v₁ = target's rate,
//   −H v₁ in the normal cone of K at w: each friction element bears any w inside its convex set K and slides
//   only on the set's boundary, the way that dissipates most.
// Springs, dampers and contacts enter linearised at the step's begin (linearization.h) and implicitly, so that
// no stiffness limits the step; which contacts press is found by repeating the step until the pressed ones
// are those that the end asks for. Friction is the convex problem of friction_modes.h with velocities in
// place of accelerations, solved by block Gauss–Seidel over the elements; normal forces are those of the
// step's end, found by repetition. Joints and drives are then met by projection.
//
// First order; no event is located, nothing is asked twice: chattering, simultaneous impacts and jumps cost
// no more than smooth motion. Vibrations of period T are damped by 2π²h/T of their amplitude in each period
// (implicit Euler). Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics
// (CISM 302, 1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235.
#pragma once

#include "mbd/integrators/stage_system.h"

namespace steplap {

class TimeStepping {
public:
  explicit TimeStepping(const System& system);

  /// Advances `state` by h to its time t1 = t + h, with contact modes, friction phases, anchors, and the two
  /// integrals of power. `dynamics` is left with `state` set. Locks and rows are met to `tolerance`.
  void step(Dynamics& dynamics, State& state, double t1, double tolerance);

  /// Largest residuals met before projection in the last step.
  [[nodiscard]] const Residual& residual() const { return residual_; }

private:
  struct FrictionPart {
    int friction = 0, first = 0, dimension = 0; ///< first: among the rows of all parts
    bool is_kinetic = false;
    FrictionBlock block;
  };
  void collect_friction(Dynamics& dynamics, State& state);
  [[nodiscard]] bool has_held(const FrictionState& friction, int f) const;
  void load_row(const Dynamics& dynamics, const RowSpec& spec, std::size_t r);
  void respond(const Dynamics& dynamics, const double* y0);
  void balance_friction(const Dynamics& dynamics);
  void hold_together();
  bool update_modes(Dynamics& dynamics, State& state);
  void finish_phases(Dynamics& dynamics, State& state, double h);

  const System& system_;
  Linearization linearization_;
  StageSystem stages_;
  Residual residual_;
  State start_;
  std::vector<FrictionPart> parts_;
  int n_ = 0;
  std::vector<double> y0_, y1_, dy_, right_, free_, change_;
  std::vector<std::vector<double>> gradient_; ///< per friction row: n entries
  std::vector<std::vector<double>> response_; ///< per friction row: 2n, change of state by a unit force
  std::vector<double> compliance_, rate_, wrench_;
};

} // namespace steplap
