// The layout of a mode: which bodies move as one, which coordinates are driven, which rows hold.
//
// Bodies held rigidly together (welds, sticking step-lap joints) are merged into *clusters* that are
// integrated as one body about their common centre of gravity; a coordinate that a drive prescribes is
// locked (infinite mass); what remains are rows. A layout is found once for a set of modes.
//
// Coordinates are the clusters' own, x, y and θ of each, or, in small islands with pins, joint coordinates
// (mechanism.h). Clusters and active rows are numbered so that those in absolute coordinates come first, then those
// of mechanisms; coordinates likewise.
#pragma once

#include "mbd/dynamics/load_sharing.h"
#include "mbd/dynamics/mechanism.h"
#include "mbd/dynamics/schur.h"
#include "mbd/system/system.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <vector>

namespace steplap {

class StageProgram;

/// What describes islands for which there is a choice; `automatic`: joint coordinates where they pay.
enum class Coordinates : unsigned char { automatic, joint, absolute };

/// Several bodies moving as one; coordinates are those of its centre of gravity.
struct Cluster {
  double mass = 0.0, inertia = 0.0;
  double w[3] = {0, 0, 0}; ///< 1/m, 1/m, 1/J; 0 where locked
  int root = 0;            ///< the body whose angle it carries
  int motion = 0;          ///< slot of its motion: the body's own if it is alone, else an extra one
};

/// Place of a body in its cluster.
struct Placement {
  int cluster = -1;                     ///< −1: the ground
  bool is_alone = true;                 ///< the only body of its cluster
  bool is_trivial = true;               ///< it moves as its cluster does: alone, or placed at its centre of gravity
  Vec2 offset = Vec2::Zero();           ///< centre of gravity in the cluster's axes
  double angle = 0.0, c = 1.0, s = 0.0; ///< against the cluster's
};

/// Rows of a cluster against another or the ground that have a way of their own in Dynamics: with bodies alone
/// in their clusters, or for angles.
enum class RowPullKind : unsigned char { other, angle, axis, slide };

/// Where the row comes from.
struct ActiveRow {
  const RowSpec* spec = nullptr;
  int row = -1;      ///< bilateral row, or −1
  int friction = -1; ///< friction element and which of its rows, or −1
  int friction_row = 0;
  int link = 0;          ///< slot of the row's bodies
  bool is_simple = true; ///< both bodies are clusters of their own, or the ground
  RowPullKind pull = RowPullKind::other;
};

/// Row `row` of the layout's schur_rows acts with its side `side` on a locked coordinate.
struct LockedTerm {
  int row = 0, side = 0;
  int multiplier = 0; ///< the active row that it is, or is a part of
};

/// A driven coordinate of a cluster that consists of one body.
struct Lock {
  int cluster = 0, coordinate = 0;
  int row = 0;                   ///< the bilateral row it stands for
  double offset = 0.0;           ///< m: of the coordinate against what the row measures, which is seen from a point of the ground
  std::vector<LockedTerm> terms; ///< active rows that act on its cluster
};

/// A link between two bodies that an evaluation needs.
struct ActiveLink {
  int slot = 0, a = 0, b = 0;
};

/// The multiplier of an active row is the force of a friction element.
struct HeldRow {
  int row = 0;
  int friction_row = 0; ///< slot in Snapshot::friction_force
};

/// A rigid joint inside a cluster: `child` hangs on `parent`; leaves first.
struct RigidEdge {
  int parent = 0, child = 0;
  int block = -1;    ///< row block, or −1
  int friction = -1; ///< friction element, or −1
};

/// Where a rigid joint lies in the axes of its cluster, which do not change while it sticks.
struct EdgeGeometry {
  Pair<double> lever;      ///< from the parent's centre of gravity to the child's
  Pair<double> axis[2];    ///< of the joint's rows
  Pair<double> point;      ///< of the joint, from the centre of gravity of the rows' body a
  bool is_child_a = false; ///< the child is the rows' body a
};

/// A coordinate as error scales see it.
struct CoordinateScale {
  bool is_place = true; ///< m, else rad
  double reach = 0.0;   ///< m: how far what an angle turns, beside its own body, is from its pin
};

/// Phases and places of friction, and the choice of coordinates, by which layouts are told apart.
using LayoutKey = std::vector<std::uint64_t>;

struct Layout {
  Layout();
  ~Layout();
  Layout(Layout&&) noexcept;
  Layout& operator=(Layout&&) noexcept;

  LayoutKey key;
  std::vector<Cluster> clusters;
  int absolute_count = 0;            ///< clusters in absolute coordinates, the first ones
  std::vector<Mechanism> mechanisms; ///< of the others
  int coordinate_count = 0;
  std::vector<CoordinateScale> scales; ///< per coordinate
  std::vector<Placement> placements;   ///< per body
  std::vector<int> riding;             ///< bodies whose motion is not their cluster's, that forces or rows act on
  std::vector<int> riding_along;       ///< the others whose motion is not their cluster's
  std::vector<int> slots;              ///< of the clusters' motions and forces
  int slot_count = 0;                  ///< those in use: bodies, links, clusters of several bodies

  std::vector<ActiveRow> active; ///< of clusters in absolute coordinates first, then of each mechanism
  std::vector<Lock> locks;
  std::vector<double> weight;       ///< m g, per coordinate of the absolute clusters
  std::vector<double> inverse_mass; ///< W of those; 1 for a joint coordinate
  std::vector<RigidEdge> edges;
  std::vector<char> is_carried;      ///< per body: child of an edge, whose wrench balance is wanted
  std::vector<int> carried_rows;     ///< active rows that act on such a body
  bool is_carried_by_pins = false;   ///< pins of mechanisms do
  std::vector<int> redundant_blocks; ///< rigid blocks inside one cluster that close a loop
  std::vector<ActiveLink> links;
  std::vector<int> sliding;                            ///< friction elements in phase slip
  std::vector<int> sliding_link;                       ///< slot of each of those
  std::vector<int> holding;                            ///< friction elements in phase stick that are not merged
  std::vector<int> merged;                             ///< friction elements in phase stick that are merged
  bool can_merged_slip = false;                        ///< some of those can
  bool is_merged_watched = false;                      ///< and are watched, as sticking elements that share a load are
  std::unique_ptr<LoadSharing> sharing;                ///< null until rows have been met that depend on each other
  std::vector<double> reference;                       ///< coordinates in the reference pose, for error scales
  std::vector<HeldRow> held_rows;                      ///< of the elements in `holding`
  std::vector<char> is_friction_row;                   ///< per active row: it holds friction that can slip
  std::vector<int> driven_rows;                        ///< active rows that move with time
  SchurSolver schur;                                   ///< of the rows between absolute clusters
  std::vector<SchurRow> schur_rows;                    ///< per active row, then per part: bodies filled in, numbers are scratch
  std::vector<SchurPart> parts;                        ///< of rows over more than two bodies; those are between absolute clusters
  std::vector<const RowSpec*> part_specs;              ///< of each of those
  std::vector<std::unique_ptr<StageProgram>> programs; ///< of sets of modes that have this layout (stage_program.h)

  /// As when it was made: what rows share hangs on the pose in which that was first asked for.
  void forget_sharing() {
    sharing.reset();
    is_merged_watched = can_merged_slip;
  }
  [[nodiscard]] int cluster_count() const { return static_cast<int>(clusters.size()); }
  /// Some rows that hold are over more than two bodies.
  [[nodiscard]] bool has_long_rows() const { return !parts.empty(); }
  /// Some clusters are in joint coordinates.
  [[nodiscard]] bool has_mechanisms() const { return !mechanisms.empty(); }
  /// The mechanism of a cluster or row that is not absolute.
  [[nodiscard]] const Mechanism& mechanism_of_cluster(int cluster) const {
    return *std::prev(
        std::upper_bound(mechanisms.begin(), mechanisms.end(), cluster, [](int k, const Mechanism& m) { return k < m.first_cluster; }));
  }
  [[nodiscard]] const Mechanism& mechanism_of_row(int row) const {
    return *std::prev(
        std::upper_bound(mechanisms.begin(), mechanisms.end(), row, [](int r, const Mechanism& m) { return r < m.first_row; }));
  }

  // Of all constraint equations, as SchurSolver says of its own.
  [[nodiscard]] bool is_singular() const {
    bool is_any = schur.is_singular();
    for (const Mechanism& m : mechanisms) is_any = is_any || m.is_singular();
    return is_any;
  }
  [[nodiscard]] double smallest_pivot() const {
    double least = schur.smallest_pivot();
    for (const Mechanism& m : mechanisms) least = std::min(least, m.smallest_pivot());
    return least;
  }
  [[nodiscard]] bool is_dependent(int row) const {
    if (row < schur.size()) return schur.is_dependent(row);
    const Mechanism& m = mechanism_of_row(row);
    return m.is_dependent(row - m.first_row);
  }
  [[nodiscard]] bool is_rank_open(int row) const {
    return row < schur.size() ? schur.is_rank_open() : mechanism_of_row(row).is_rank_open();
  }
  [[nodiscard]] bool is_left_out(int row) const {
    if (row < schur.size()) return schur.is_left_out(row);
    const Mechanism& m = mechanism_of_row(row);
    return m.is_left_out(row - m.first_row);
  }
};

void layout_key(const State& state, Coordinates coordinates, LayoutKey& key);

/// Which bodies move as one, and where they are held against each other.
struct MergedBodies {
  std::vector<int> frictions; ///< sticking joints that merge bodies, beside all welds
  std::vector<Cluster> clusters;
  std::vector<Placement> placements; ///< per body
};
/// Elements that stick and merge their two bodies while they do.
[[nodiscard]] std::vector<int> merging_frictions(const System& system, const State& state);
/// In the friction phases and poses of `state`.
[[nodiscard]] MergedBodies merge_bodies(const System& system, const State& state);

/// The layout for the friction phases in `state`, with bodies merged where they are held in `merged`, or in `state`.
[[nodiscard]] Layout make_layout(const System& system, const State& state, Coordinates coordinates, const MergedBodies& merged);
[[nodiscard]] Layout make_layout(const System& system, const State& state, Coordinates coordinates = Coordinates::absolute);

} // namespace steplap
