// A mechanism on numbers that are written down: what Mechanism does in an evaluation, in the same order.
#pragma once

#include "mbd/dynamics/mechanism_work.h"

namespace steplap {

class TracedMechanism {
public:
  explicit TracedMechanism(const Mechanism& mechanism);
  [[nodiscard]] const Mechanism& constants() const { return mechanism_; }

  /// As in Mechanism: q, v, s, lambda, change are the mechanism's own, `rows` its first row.
  void place(const Traced* q, const Traced* v, Motion<Traced>* motion) { work_.place(q, v, motion); }
  void accelerate(const BodyForceOf<Traced>* force, Traced* s);
  void expand(const Traced* s, Traced* cluster_a) { work_.expand(s, cluster_a); }
  /// Throws NotTraceable where a pivot is below `least_pivot` of its diagonal, which the tape makes a condition.
  /// Adds its pivots.
  void solve_rows(const SchurRowOf<Traced>* rows, double least_pivot, Traced* lambda, Traced* change, std::vector<TracedPivot>& pivots);

private:
  void solve_mass(Traced* x) const;

  const Mechanism& mechanism_;
  MechanismWorkOf<Traced> work_;
};

} // namespace steplap
