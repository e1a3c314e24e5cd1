// Edges of core sheets that bear on each other: a limb drawn towards its yoke by more than the clearance of a layer
// butts along the mitre.
//
// One *edge line* for each interface that states its clearance: the side of its overlap where the limb's sheet ends,
// fixed in the limb, against a parallel line fixed in the active part that lies the clearance beyond it in the
// reference pose. The sheets' edges are a Winkler bed: a line load q = k d where they are pressed in by d ≥ 0, k in N/m
// per metre of line, of all sheets at the corner together, shared among the interfaces of a corner as they are counted.
// With the depths d₁, d₂ at the line's ends (straight in between, length l; negative where it is open) the stored
// energy is
//   both pressed:      U = k l (d₁² + d₁d₂ + d₂²)/6
//   only end 1:        U = k l d₁³/(6 (d₁ − d₂)),   over the length l d₁/(d₁ − d₂)
// and the force on the limb −∂U/∂(pose): exactly conservative, whatever the limb turns by. Nothing is lost, no force
// acts along the line (friction of edges is left out: it would hold the limb back), and edges never pull.
//
// Lines of a corner that are parallel and have the same clearance are one *bed*. The gap of such lines is linear along
// the mitre whatever the limb turns by, so that all of them close within the time in which the longest one does. Events
// are those of the bed: its first end begins or its last end ceases to bear (closes, opens), all ends bear (passes a
// kink). In between each line follows from its own depths: with one end alone its force grows as d₁², without a jump of
// its slope, so that no event is needed there.
#pragma once

#include "elements/step_lap/step_lap_interface.h"
#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Depths at both ends of a line and the forces ∂U/∂d there.
template <class S> struct EdgePress {
  S force[2] = {S(0), S(0)};
};

/// Of a bed: nothing of it bears, something does, all ends of all lines do.
inline constexpr UnitMode k_bed_open = 0, k_bed_partly = 1, k_bed_whole = 2;

class EdgeGroup final : public ForceGroup {
public:
  struct Line {
    AxisMeasure gap[2];     ///< of its ends, m; pressed where negative
    double stiffness = 0.0; ///< k, N/m²
    double length = 0.0;    ///< m
  };
  /// A bed.
  struct Entry {
    int a = k_ground, b = k_ground; ///< limb, active part
    double clearance = 0.0;         ///< m, of all its lines
    std::vector<Line> lines;
    int link = 0, unit = 0, watch = 0;
  };
  static constexpr int k_watches = 2;
  std::vector<Entry> entries;

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>* motion) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void enter_links(LinkTable& links) override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind transition(UnitMode from, UnitMode to) const override;

  /// Of one bed, at a motion: force on the limb off the yoke, N; line loads at both ends, N/m, of its lines together.
  struct Bearing {
    double force = 0.0, load[2] = {0.0, 0.0};
  };
  [[nodiscard]] Bearing bearing(int element, const Motion<double>* motion) const;
};

/// The side of an overlap where the limb's sheet ends. Points in the active part's axes; `off`: normal, off the yoke.
struct EdgeLine {
  Vec2 ends[2] = {Vec2::Zero(), Vec2::Zero()};
  Vec2 off = Vec2::Zero();
  [[nodiscard]] bool is_known() const { return off != Vec2::Zero(); }
};
[[nodiscard]] EdgeLine find_edge_line(const SheetPair& sheets, const Pose& reference);

} // namespace steplap
