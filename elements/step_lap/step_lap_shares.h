// What each corner and each packet of a step-lap joint could hold by itself.
//
// The limit surface is one of the whole joint: a corner that is not clamped, or a packet of sheets that nothing presses, is made
// up for by the others in a sum, while its own sheets rest on nothing. So each has to hold its own share as well: a packet, of the
// limb's weight and of the force on the limb, whichever is larger, the share that its sheets have of its mass
// (StepLapInterface::part_share), since it moves as the limb does and nothing but its own friction moves it. Of n corners each has to hold
// 1/n of the weight: how stiff sheets share what the motion asks beyond it is no matter of statics, and is judged of the whole joint.
// A limb has its weight in a model without gravity, too, which shows it from above. The capacity is that in translation, Σ n μ p A over the interfaces in the reference pose, μ static, which no wrench
// exceeds. A corner without overlap and interfaces without pressure have no capacity: their margin is zero.
#pragma once

#include "elements/step_lap/step_lap_friction.h"

#include <algorithm>
#include <vector>

namespace steplap {

class GripShares {
public:
  /// `interfaces` as the friction's sheets, `weight` of the limb, N, > 0.
  GripShares(const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces, double weight);

  /// Pa: the least that any interface has anywhere in its overlap; zero where tilting has lifted it off.
  [[nodiscard]] double least_pressure(const PressureState& now) const;
  /// Capacity over what it has to hold, of the corner that has least.
  [[nodiscard]] double corner_margin(const PressureState& now) const { return least_margin(corners_, now, weight_); }
  /// The same of packets; only where has_parts(). `demand`: N, size of the force on the limb.
  [[nodiscard]] double part_margin(const PressureState& now, double demand) const {
    return least_margin(parts_, now, std::max(weight_, demand));
  }
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
  [[nodiscard]] double least_margin(const std::vector<Group>& groups, const PressureState& now, double load) const;

  double weight_;
  std::vector<Sheet> sheets_;
  std::vector<Group> corners_, parts_;
};

/// "least_pressure", "corner_margin", "part_margin", "demand".
void add_share_channels(SystemBuilder& builder, const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces,
                        double weight);

} // namespace steplap
