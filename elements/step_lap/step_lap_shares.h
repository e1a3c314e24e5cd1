// Capacity of each corner and each packet of a step-lap joint alone.
//
// The limit surface is that of the whole joint, in which a corner without clamping, or a packet of sheets without pressure, is compensated
// by the others although its own sheets are not held. Each corner and packet must therefore also carry its own share. A packet moves with
// the limb, driven by its own friction only; it must carry its mass fraction (StepLapInterface::part_share) of the limb's weight or of the
// force on the limb, whichever is larger. Each of n corners must carry 1/n of the weight; the distribution of dynamic loads among the stiff
// sheets is not determined by statics and is judged for the whole joint. The weight also counts in a model without gravity, which shows the
// core from above. The capacity is that in translation, Σ n μ p A over the interfaces in the reference pose with static μ, an upper limit
// for all wrenches. Corners without overlap and interfaces without pressure have zero capacity, hence zero margin.
#pragma once

#include "elements/step_lap/step_lap_friction.h"

#include <algorithm>
#include <vector>

namespace steplap {

/// Capacities of the corners and packets of one joint.
class GripShares {
public:
  /// `interfaces`: in the order of the friction's sheets; `weight`: weight of the limb, N, > 0.
  GripShares(const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces, double weight);

  /// Returns the smallest pressure of any interface anywhere in its overlap, Pa; zero if tilting has relieved it.
  [[nodiscard]] double least_pressure(const PressureState& now) const;
  /// Returns the smallest ratio of capacity to required share over all corners.
  [[nodiscard]] double corner_margin(const PressureState& now) const { return least_margin(corners_, now, weight_); }
  /// Returns the smallest ratio of capacity to required share over all packets. Precondition: has_parts(). `demand`: magnitude of the force
  /// on the limb, N.
  [[nodiscard]] double part_margin(const PressureState& now, double demand) const {
    return least_margin(parts_, now, std::max(weight_, demand));
  }
  [[nodiscard]] std::size_t corner_count() const { return corners_.size(); }
  [[nodiscard]] bool has_parts() const { return !parts_.empty(); }

private:
  struct Sheet {
    double pressure = 0.0;   ///< pressure at the middle of its overlap, Pa
    double capacity = 0.0;   ///< capacity without transverse acceleration, N
    double transverse = 0.0; ///< relative change of the traction per m/s², as in SheetPair
    double spread = 0.0;     ///< largest deviation (±) of `transverse` among the sheets
    double least = 1.0;      ///< smallest pressure in its overlap without transverse acceleration, as a fraction of `pressure`
  };
  struct Group {
    double share = 0.0;
    std::vector<Sheet> tilting; ///< sheets whose pressure changes with the transverse acceleration
    double capacity = 0.0;      ///< capacity of the sheets with constant pressure, N
    void add(const Sheet& sheet);
    [[nodiscard]] double capacity_at(const PressureState& now) const;
  };
  [[nodiscard]] double least_margin(const std::vector<Group>& groups, const PressureState& now, double load) const;

  double weight_;
  std::vector<Sheet> sheets_;
  std::vector<Group> corners_, parts_;
};

/// Adds the channels "least_pressure", "corner_margin", "part_margin" and "demand".
void add_share_channels(SystemBuilder& builder, const StepLapFriction& friction, const std::vector<const StepLapInterface*>& interfaces,
                        double weight);

} // namespace steplap
