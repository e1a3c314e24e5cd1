// Contact of the edges of core sheets: a limb that moves towards its yoke by more than the clearance of a layer butts along the mitre.
//
// Each interface with a given clearance has one edge line: the side of its overlap at which the limb's sheet ends, fixed in the limb, and a
// parallel line fixed in the active part, one clearance away in the reference pose. The sheet edges are a Winkler foundation: line load q =
// k d for penetration d ≥ 0, with k in N/m per metre of line for all sheets at the corner together, distributed over the interfaces of a
// corner by their numbers. With the penetrations d₁, d₂ at the ends of the line (linear in between, length l; negative where open) the
// stored energy is
//
//   both pressed:      U = k l (d₁² + d₁d₂ + d₂²)/6
//   only end 1:        U = k l d₁³/(6 (d₁ − d₂)),   over the length l d₁/(d₁ − d₂)
//
// and the force on the limb −∂U/∂(pose), exactly conservative for any rotation. There is no dissipation and no friction along the line (it
// would support the limb, so neglecting it is conservative), and edges do not pull.
//
// Parallel lines of a corner with the same clearance form one bed. Their gap is linear along the mitre, so all of them close within the
// time in which the longest one does. Events belong to the bed: its first end closes or its last end opens (closes, opens), and all ends
// are closed (passes a kink). In between each line depends on its own penetrations: with one end closed its force grows with d₁², without a
// jump of slope, so no event is needed.
#pragma once

#include "elements/step_lap/step_lap_interface.h"
#include "mbd/system/system.h"

#include <vector>

namespace steplap {

/// Forces ∂U/∂d at both ends of a line.
template <class S> struct EdgePress {
  S force[2] = {S(0), S(0)};
};

/// Modes of a bed: no end is closed; some are; all ends of all lines are.
inline constexpr UnitMode k_bed_open = 0, k_bed_partly = 1, k_bed_whole = 2;

/// All beds of edges, as one force group.
class EdgeGroup final : public ForceGroup {
public:
  /// A line along which two edges can touch.
  struct Line {
    AxisMeasure gap[2];     ///< gaps at the ends of the line, m; closed if negative
    double stiffness = 0.0; ///< stiffness k per length of the line, N/m²
    double length = 0.0;    ///< length of the line, m
  };
  /// Parallel lines of one corner with equal clearance.
  struct ElementData {
    int a = k_ground, b = k_ground; ///< indices of the limb and of the active part
    double clearance = 0.0;         ///< clearance of all lines of the bed, m
    std::vector<Line> lines;
    int link = 0, unit = 0, first_event = 0;
  };
  static constexpr int k_event_count = 2;
  std::vector<ElementData> entries;

  void add_forces(Evaluation& e) const override;
  [[nodiscard]] double potential(const Motion<double>* motion) const override;
  void add_jacobian(const Evaluation& e, std::vector<PairJacobian>& out) const override;
  void mark_bodies(std::vector<char>& is_used) const override;
  void register_links(LinkTable& links) override;
  [[nodiscard]] UnitMode initial_mode(int element, const Evaluation& e) const override;
  [[nodiscard]] UnitMode next_mode(int element, UnitMode mode, int slot, const Evaluation& e) const override;
  [[nodiscard]] EventKind event_kind(UnitMode from, UnitMode to) const override;

  /// Load of one bed: force on the limb away from the yoke, N; line loads at both ends, N/m, as sums over its lines.
  struct Bearing {
    double force = 0.0, load[2] = {0.0, 0.0};
  };
  /// Returns the load of bed `element` for the given motion.
  [[nodiscard]] Bearing bearing(int element, const Motion<double>* motion) const;
};

/// Side of an overlap at which the limb's sheet ends. Points in the axes of the active part; `off`: unit normal away from the yoke, zero if
/// unknown.
struct EdgeLine {
  Vec2 ends[2] = {Vec2::Zero(), Vec2::Zero()};
  Vec2 off = Vec2::Zero();
  [[nodiscard]] bool is_known() const { return off != Vec2::Zero(); }
};
/// Returns the edge line of one interface in the reference pose.
[[nodiscard]] EdgeLine find_edge_line(const SheetPair& sheets, const Pose& reference);

} // namespace steplap
