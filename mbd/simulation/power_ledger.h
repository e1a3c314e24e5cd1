// Integrals of power that channels on request ask for (System::integrands): energy that single elements have dissipated,
// work that they have done.
//
// They are no part of the state, so that asking for them changes no step and no bit of the motion. Over each step, up to an
// event inside it, the powers are taken on the dense output at the points of Gauss and Lobatto: seven of methods that
// choose their steps (exact to degree 11 at the step's end, 6 within), three of those that do not (3 and 2, as good as their own
// order). Time stepping takes the power of a step's end for all of it, as it books the energies of the whole. What an event takes
// from stored energy at once (a tie that breaks) counts with the integral of that element.
#pragma once

#include "mbd/integrators/integrator.h"

#include <vector>

namespace steplap {

/// Integrates powers beside a run; one per Simulation.
class PowerLedger final : public Integrals {
public:
  /// `max_dimension`: of the packed state; `memory`: the state's, before the blows that it took as the motion began. Refers to the system.
  PowerLedger(const System& system, int max_dimension, std::vector<double> memory);

  /// What `before` had come to counts from here on: of another system with the same integrands.
  void go_on_from(const PowerLedger& before) { total_ = before.total_; }
  /// A state from which the motion goes on anew: the start, the far side of an event.
  void begin(double t, const Snapshot& snapshot);
  /// The step just made counts up to t.
  void add_step(double t, Integrator& integrator, Dynamics& dynamics);
  /// The same of time stepping, since t was last known; `snapshot` at t.
  void add_stepped(double t, const Snapshot& snapshot);
  /// An event is about to be handled, at `snapshot`.
  void end(const Snapshot& snapshot);
  /// Does any integrand take energy from what is stored at events?
  [[nodiscard]] bool has_stored() const { return has_stored_; }

  [[nodiscard]] double value(int slot, double t) const override;

private:
  static constexpr int k_nodes = 7;         ///< at most
  static constexpr std::size_t k_kept = 40; ///< stretches that may still be asked for (ExtremeFinder::k_longest, twice)
  /// ∫ power over part of a step: base + h Σ coefficient_k θ^(k+1)/(k+1).
  struct Piece {
    double t0 = 0.0, h = 0.0;
    std::vector<double> base, coefficient; ///< per integrand; k_nodes of each
  };

  Piece& next_piece(double t0, double h);
  void close(const Piece& piece);

  const System& system_;
  std::vector<double> unhurt_; ///< memory before the first blows
  std::size_t count_;
  std::vector<Piece> pieces_; ///< a ring
  std::size_t last_ = 0, known_ = 0;
  double t_ = 0.0;
  std::vector<double> total_, stored_;
  bool has_stored_ = false, is_ended_ = false;
  std::vector<double> y_, dy_;
};

} // namespace steplap
