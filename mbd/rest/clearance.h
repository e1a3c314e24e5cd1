// Limits displacements of bodies such that they cannot pass through each other unnoticed.
//
// Conservative advancement (B. V. Mirtich, PhD thesis, Berkeley 1996): a gap decreases by no more than the path of the parts that may touch
// (gap_source.h), so a shorter displacement closes no contact. If the gap is small compared with the thickness of the parts, a displacement
// may exceed it by up to a quarter of the thickness: the penetration is then noticed while the contact force still pushes outwards.
#pragma once

#include "mbd/system/gap_source.h"
#include "mbd/system/system.h"

namespace steplap {

class Clearance {
public:
  /// `touch`: gaps below it count as rounding, m.
  Clearance(const System& system, double touch);

  [[nodiscard]] bool is_endless() const { return sources_.empty(); }
  /// Measures all gaps with bodies at the poses `q`, three numbers for each body, the ground first. The last measurement becomes the one
  /// before; if `is_instead`, it is discarded, and the one before is kept.
  void measure(const std::vector<double>& q, bool is_instead = false);
  /// Returns the fraction of a displacement from the measured poses (three numbers for each body except the ground) that is safe in one
  /// step; above 1 if the whole displacement is safe. Contacts that are closed already are checked by keeps_sides().
  [[nodiscard]] double share(const VecX& displacement) const;
  /// Returns true if, between the last two measurements, no contact can have closed and opened again, and contacts closed at both are
  /// pressed on the same side. `displacement` is the difference of the poses.
  [[nodiscard]] bool keeps_sides(const VecX& displacement) const;
  /// Returns true if, between the last two measurements, a contact has closed, or has become deeper than half the thickness of a part.
  [[nodiscard]] bool has_met() const;

private:
  std::vector<const GapSource*> sources_;
  double touch_ = 0.0;
  std::vector<double> still_;
  std::vector<Motion<double>> motion_;
  std::vector<GapBounds> now_, before_;
};

} // namespace steplap
