// Time integrals of powers for channels on request (System::integrands): dissipated energy and work of single elements.
//
// They are not part of the state, so that requesting them changes neither steps nor motion. Over each step (up to an event in it) the
// powers are evaluated on the dense output at Gauss–Lobatto points: seven for adaptive methods (exact to degree 11 at the end of the step,
// 6 within), three for fixed steps (3 and 2, sufficient for their order). Time stepping uses the power at the end of a step for the whole
// step, as in its energy account. A sudden decrease of stored energy at an event (a tie that breaks) is added to the integral of that
// element.
#pragma once

#include "mbd/integrators/integrator.h"

#include <vector>

namespace steplap {

/// Integrates powers during a run; one per Simulation.
class PowerLedger final : public Integrals {
public:
  /// `max_dimension`: upper limit of the dimension of the packed state; `impacts`: State::impacts before the impacts at the start. Keeps a
  /// reference to the system.
  PowerLedger(const System& system, int max_dimension, std::vector<Impact> impacts);

  /// Continues with the integrals of `before`, whose system has the same integrands.
  void go_on_from(const PowerLedger& before) { total_ = before.total_; }
  /// Restarts at a state: the start of the run, or after an event.
  void begin(double t, const Snapshot& snapshot);
  /// Integrates over the last step, up to time t, s.
  void add_step(double t, Integrator& integrator, Dynamics& dynamics);
  /// Integrates over an interval of time stepping, from the last known time to t, s. `snapshot`: evaluation at t.
  void add_stepped(double t, const Snapshot& snapshot);
  /// To be called before an event is handled, with the evaluation before it.
  void end(const Snapshot& snapshot);
  /// Returns true if some integrand includes a change of stored energy.
  [[nodiscard]] bool has_stored() const { return has_stored_; }

  [[nodiscard]] double value(int slot, double t) const override;

private:
  static constexpr int k_nodes = 7;         ///< largest number of nodes
  static constexpr std::size_t k_kept = 40; ///< number of pieces kept; ExtremeFinder requests none that are older (k_longest, twice)
  /// ∫ power over part of a step, J: base + h Σ coefficient_k θ^(k+1)/(k+1).
  struct Piece {
    double t0 = 0.0, h = 0.0;
    std::vector<double> base, coefficient; ///< per integrand: base; coefficient has k_nodes numbers each
  };

  Piece& next_piece(double t0, double h);
  void close(const Piece& piece);

  const System& system_;
  std::vector<Impact> impacts_before_; ///< State::impacts before the impacts at the start
  std::size_t count_;
  std::vector<Piece> pieces_; ///< ring buffer of the last k_kept pieces
  std::size_t last_ = 0, known_ = 0;
  double t_ = 0.0;
  std::vector<double> total_, stored_;
  bool has_stored_ = false, is_ended_ = false;
  std::vector<double> y_, dy_;
};

} // namespace steplap
