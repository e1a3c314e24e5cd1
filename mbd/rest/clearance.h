// Largest displacement of bodies in one step that cannot take them through each other unnoticed.
//
// Conservative advancement (B. V. Mirtich, PhD thesis, Berkeley 1996): a gap decreases by no more than the path of the parts that may touch
// (gap_source.h), so no contact can close before. If a gap is small compared with the thickness of the parts, a step may go a quarter of
// that thickness deep: the penetration is then noticed while the contact force still pushes outwards.
#pragma once

#include "mbd/system/gap_source.h"
#include "mbd/system/system.h"

namespace steplap {

class Clearance {
public:
  /// `touch`: gaps below it are rounding, m.
  Clearance(const System& system, double touch);

  [[nodiscard]] bool is_endless() const { return sources_.empty(); }
  /// Measures the gaps with bodies at the poses `q`, three numbers each, the ground first. The previous measurement is kept; if
  /// `is_instead`, this one replaces the last and the one before is kept.
  void measure(const std::vector<double>& q, bool is_instead = false);
  /// Returns the share of a displacement (three numbers per body without the ground) from the measured poses that is safe in one step;
  /// above 1 if all of it is. Contacts already pressed are checked by keeps_sides().
  [[nodiscard]] double share(const VecX& displacement) const;
  /// Returns true if between the last two measurements, which are this displacement apart, no contact can have closed and opened again, and
  /// contacts pressed at both are pressed on the same side.
  [[nodiscard]] bool keeps_sides(const VecX& displacement) const;
  /// Returns true if since the measurement before a contact has closed, or has become deeper than half the thickness of a part.
  [[nodiscard]] bool has_met() const;

private:
  std::vector<const GapSource*> sources_;
  double touch_ = 0.0;
  std::vector<double> still_;
  std::vector<Motion<double>> motion_;
  std::vector<GapBounds> now_, before_;
};

} // namespace steplap
