// What each corner and each packet of a step-lap joint could hold by itself.
//
// The limit surface is one of the whole joint: a corner that is not clamped, or a packet of sheets that nothing presses, is made
// up for by the others in a sum, while its own sheets rest on nothing. So each has to hold its own share of the limb's weight as
// well: of n corners 1/n, a packet the share that its sheets have (StepLapInterface::part_share). Its capacity is that in translation,
// Σ n μ p A over its interfaces in the reference pose, μ static, which no wrench exceeds. What the motion asks beyond the weight
// is judged of the whole joint. A corner without overlap and interfaces without pressure have no capacity: their margin is zero.
#pragma once

#include "elements/step_lap_friction.h"

#include <vector>

namespace steplap {

class GripShares {
public:
  /// `interfaces` as the friction's sheets, `weight` of the limb, N.
  GripShares(const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces, double weight);

  /// Pa: the least that any interface has anywhere in its overlap; zero where tilting has lifted it off.
  [[nodiscard]] double least_pressure(const PressureState& now) const;
  /// Capacity over share of the weight of the corner that has least; infinite without weight.
  [[nodiscard]] double corner_margin(const PressureState& now) const { return least_margin(corners_, now); }
  /// The same of packets; only where has_parts().
  [[nodiscard]] double part_margin(const PressureState& now) const { return least_margin(parts_, now); }
  [[nodiscard]] std::size_t corner_count() const { return corners_.size(); }
  [[nodiscard]] bool has_parts() const { return !parts_.empty(); }

private:
  struct Sheet {
    double pressure = 0.0;   ///< Pa, least in its overlap
    double capacity = 0.0;   ///< N
    double transverse = 0.0; ///< as SheetPair
    double spread = 0.0;     ///< as much more or less at the outermost of its sheets
  };
  struct Group {
    double share = 0.0;
    std::vector<Sheet> tilting; ///< whose pressure changes with the acceleration across the sheets
    double capacity = 0.0;      ///< N, of the others
    void add(const Sheet& sheet);
    [[nodiscard]] double capacity_at(const PressureState& now) const;
  };
  [[nodiscard]] double least_margin(const std::vector<Group>& groups, const PressureState& now) const;

  double weight_;
  std::vector<Sheet> sheets_;
  std::vector<Group> corners_, parts_;
};

/// "least_pressure", "corner_margin", "part_margin", "demand".
void add_share_channels(SystemBuilder& builder, const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces,
                        double weight);

} // namespace steplap
