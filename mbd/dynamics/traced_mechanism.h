// The operations of Mechanism on recorded numbers, in the same order.
#pragma once

#include "mbd/dynamics/mechanism_work.h"

namespace steplap {

/// A mechanism whose motion and forces are recorded numbers; its constants are those of `mechanism`.
class TracedMechanism {
public:
  explicit TracedMechanism(const Mechanism& mechanism);
  [[nodiscard]] const Mechanism& constants() const { return mechanism_; }

  /// These functions correspond to those of Mechanism. q, v, s, lambda and change begin with the mechanism's own numbers, `rows` with its
  /// first row.
  void place(const TapeNumber* q, const TapeNumber* v, Motion<TapeNumber>* motion) { work_.place(q, v, motion); }
  void accelerate(const BodyForceOf<TapeNumber>* force, TapeNumber* s);
  void expand(const TapeNumber* s, TapeNumber* cluster_a) { work_.expand(s, cluster_a); }
  /// Solves for the multipliers of the mechanism's rows. Throws NotTraceable if a pivot is below `least_pivot` of its diagonal; the tape is
  /// valid only while all pivots are above. Appends the pivots to `pivots`.
  void solve_rows(const SchurRowOf<TapeNumber>* rows, double least_pivot, TapeNumber* lambda, TapeNumber* change,
                  std::vector<TracedPivot>& pivots);

private:
  void solve_mass(TapeNumber* x) const;

  const Mechanism& mechanism_;
  MechanismWorkOf<TapeNumber> work_;
};

} // namespace steplap
