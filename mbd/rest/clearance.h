// How far bodies may be moved at once without passing through each other.
//
// Conservative advancement (B. V. Mirtich, PhD thesis, Berkeley 1996): a gap falls by no more than the way that the touching
// parts go (gap_source.h), so that up to there nothing can have closed. Where a gap is small against what the parts are thick, a
// quarter of the way through is gone instead: what closes is then seen while its force still pushes out.
#pragma once

#include "mbd/system/gap_source.h"
#include "mbd/system/system.h"

namespace steplap {

class Clearance {
public:
  /// `touch`, m: gaps below it are rounding.
  Clearance(const System& system, double touch);

  [[nodiscard]] bool is_endless() const { return sources_.empty(); }
  /// Measures the gaps with bodies at the poses `q`, three numbers each, the ground's first. The look before is kept, or the one
  /// before that, if this one takes the place of the last.
  void look(const std::vector<double>& q, bool is_instead = false);
  /// The share of a displacement (three numbers per body, the ground left out) from the poses looked at that may be gone at
  /// once; above 1 where all of it may. What presses already is left to keeps_sides().
  [[nodiscard]] double share(const VecX& displacement) const;
  /// Between the last two looks, which lie this displacement apart: no contact can have closed and opened again, and what
  /// pressed at both is on the same side.
  [[nodiscard]] bool keeps_sides(const VecX& displacement) const;
  /// Since the look before a contact has closed, or gone more than half the way through a part, and deeper.
  [[nodiscard]] bool has_met() const;

private:
  std::vector<const GapSource*> sources_;
  double touch_ = 0.0;
  std::vector<double> still_;
  std::vector<Motion<double>> motion_;
  std::vector<GapBounds> now_, before_;
};

} // namespace steplap
