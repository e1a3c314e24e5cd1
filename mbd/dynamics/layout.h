// The layout for one set of modes: bodies merged to clusters, locked coordinates, and active rows.
//
// Bodies held rigidly together (by welds or sticking step-lap joints) are merged into clusters, each of which is integrated as one body
// with its common centre of gravity. A coordinate that a drive prescribes is locked (zero inverse mass). All other constraints are rows.
// One layout is used for all states with the same modes.
//
// Coordinates are x, y and θ of each cluster, or, in small islands with pins, joint coordinates (mechanism.h). Clusters, rows and
// coordinates in absolute coordinates are numbered first, then those of each mechanism.
#pragma once

#include "mbd/dynamics/evaluation_choices.h"
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

/// Bodies that move as one. The coordinates of the cluster are those of the common centre of gravity.
struct Cluster {
  double mass = 0.0, inertia = 0.0;
  double w[3] = {0, 0, 0}; ///< 1/m, 1/m, 1/J; 0 where locked
  int root = 0;            ///< body whose angle is the cluster's angle
  int motion = 0;          ///< slot of its motion: that of the body for a single body, otherwise an additional slot
};

/// Pose of a body in its cluster.
struct Placement {
  int cluster = -1;                     ///< −1: ground
  bool is_alone = true;                 ///< only body of its cluster
  bool is_trivial = true;               ///< moves exactly as its cluster, because it is alone or at the cluster's centre of gravity
  Vec2 offset = Vec2::Zero();           ///< centre of gravity in the axes of the cluster, m
  double angle = 0.0, c = 1.0, s = 0.0; ///< angle relative to the cluster, with cosine and sine
};

/// Functions by which gradient and bias of a row are computed. `axis` and `slide` are fast versions for bodies that are alone in their
/// clusters (or the ground), `angle` is for angle rows, `other` for all others.
enum class RowPullKind : unsigned char { other, angle, axis, slide };

/// An active constraint row and its origin.
struct ActiveRow {
  const RowSpec* spec = nullptr;
  int row = -1;      ///< index of the bilateral row, or −1
  int friction = -1; ///< friction element (or −1), and index of the row in this element
  int friction_row = 0;
  int link = 0;          ///< slot of the link between its bodies
  bool is_simple = true; ///< both bodies are alone in their clusters, or the ground
  RowPullKind pull = RowPullKind::other;
};

/// An entry of a row's gradient at a locked coordinate: side `side` of Layout::schur_rows[row].
struct LockedTerm {
  int row = 0, side = 0;
  int multiplier = 0; ///< index of the active row to which it belongs
};

/// A locked coordinate of a cluster, which consists of one body.
struct Lock {
  int cluster = 0, coordinate = 0;
  int row = 0;                   ///< bilateral row that prescribes it
  double offset = 0.0;           ///< coordinate minus value of the measure, m, since the measure refers to a point of the ground
  std::vector<LockedTerm> terms; ///< gradient entries of active rows at this coordinate
};

/// A link that an evaluation needs.
struct ActiveLink {
  int slot = 0, a = 0, b = 0;
};

/// Assigns the multiplier of an active row to the force of a friction element.
struct HeldRow {
  int row = 0;
  int friction_row = 0; ///< index in Snapshot::friction_force
};

/// A rigid joint in the spanning tree of a cluster. Lists of edges begin with the leaves.
struct RigidEdge {
  int parent = 0, child = 0;
  int block = -1;    ///< row block, or −1
  int friction = -1; ///< friction element, or −1
};

/// Geometry of a rigid joint in the axes of its cluster. It is constant while the joint sticks.
struct EdgeGeometry {
  Pair<double> lever;      ///< from the parent's centre of gravity to the child's, m
  Pair<double> axis[2];    ///< unit vectors of the joint's rows
  Pair<double> point;      ///< the joint's point, relative to the centre of gravity of the rows' body a, m
  bool is_child_a = false; ///< the child is the rows' body a
};

/// Scale of a coordinate for error control.
struct CoordinateScale {
  bool is_place = true; ///< a length in m, otherwise an angle in rad
  double reach = 0.0;   ///< for an angle: largest distance from its pin of anything that it moves besides its own body, m
};

/// Friction phases, contact points and choice of coordinates, which identify a layout.
using LayoutKey = std::vector<std::uint64_t>;

/// All quantities that depend on the modes only.
struct Layout {
  Layout();
  ~Layout();
  Layout(Layout&&) noexcept;
  Layout& operator=(Layout&&) noexcept;

  LayoutKey key;
  std::vector<Cluster> clusters;
  int absolute_count = 0;            ///< number of clusters in absolute coordinates, which come first
  std::vector<Mechanism> mechanisms; ///< mechanisms formed by the other clusters
  int coordinate_count = 0;
  std::vector<CoordinateScale> scales; ///< per coordinate
  std::vector<Placement> placements;   ///< per body
  std::vector<int> riding;             ///< bodies with forces or rows whose motions differ from those of their clusters
  std::vector<int> riding_along;       ///< other bodies whose motions differ from those of their clusters
  std::vector<int> slots;              ///< slots of the motions and forces of clusters
  int slot_count = 0;                  ///< number of slots in use: bodies, links, clusters of several bodies

  std::vector<ActiveRow> active; ///< rows between clusters in absolute coordinates first, then those of each mechanism
  std::vector<Lock> locks;
  std::vector<double> weight;       ///< m g per coordinate of absolute clusters, N
  std::vector<double> inverse_mass; ///< W of absolute clusters; 1 for a joint coordinate
  std::vector<RigidEdge> edges;
  std::vector<char> is_carried;      ///< per body: child of an edge whose wrench is computed
  std::vector<int> carried_rows;     ///< active rows that act on bodies in `is_carried`
  bool is_carried_by_pins = false;   ///< pins of mechanisms act on bodies in `is_carried`
  std::vector<int> redundant_blocks; ///< rigid row blocks inside one cluster that close a loop
  std::vector<ActiveLink> links;
  std::vector<int> sliding;                            ///< friction elements in phase slip
  std::vector<int> sliding_link;                       ///< slot of the link of each element in `sliding`
  std::vector<int> holding;                            ///< friction elements in phase stick whose rows are constraints
  std::vector<int> merged;                             ///< friction elements in phase stick that merge their bodies
  bool can_merged_slip = false;                        ///< some of the elements in `merged` can slip
  bool has_rigid_joint_events = false;                 ///< event functions of merged joints and load-sharing groups are evaluated
  std::unique_ptr<LoadSharing> sharing;                ///< null until dependent rows have occurred
  std::vector<double> reference;                       ///< coordinates in the reference pose, for error scales
  std::vector<HeldRow> held_rows;                      ///< rows of the elements in `holding`
  std::vector<char> is_friction_row;                   ///< per active row: friction that can slip
  std::vector<int> driven_rows;                        ///< active rows with time-dependent targets
  SchurSolver schur;                                   ///< solver for rows between absolute clusters
  std::vector<SchurRow> schur_rows;                    ///< per active row, then per part; the bodies are constant, the numbers scratch
  std::vector<SchurPart> parts;                        ///< further parts of rows over more than two bodies, between absolute clusters only
  std::vector<const RowSpec*> part_specs;              ///< row specification of each part
  std::vector<std::unique_ptr<StageProgram>> programs; ///< compiled stages of this layout, one for each set of modes (stage_program.h)

  /// Discards the load sharing, as if the layout were new. It depends on the pose in which it was computed first.
  void forget_sharing() {
    sharing.reset();
    has_rigid_joint_events = can_merged_slip;
  }
  [[nodiscard]] int cluster_count() const { return static_cast<int>(clusters.size()); }
  /// Returns true if an active row acts on more than two bodies.
  [[nodiscard]] bool has_long_rows() const { return !parts.empty(); }
  /// Returns true if some clusters are in joint coordinates.
  [[nodiscard]] bool has_mechanisms() const { return !mechanisms.empty(); }
  /// Return the mechanism that contains the cluster or the row. Precondition: it is not in absolute coordinates.
  [[nodiscard]] const Mechanism& mechanism_of_cluster(int cluster) const {
    return *std::prev(
        std::upper_bound(mechanisms.begin(), mechanisms.end(), cluster, [](int k, const Mechanism& m) { return k < m.first_cluster; }));
  }
  [[nodiscard]] const Mechanism& mechanism_of_row(int row) const {
    return *std::prev(
        std::upper_bound(mechanisms.begin(), mechanisms.end(), row, [](int r, const Mechanism& m) { return r < m.first_row; }));
  }

  // The following functions combine the results of `schur` and of all mechanisms.
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

/// Writes the key of the layout for `state` to `key`.
void layout_key(const State& state, Coordinates coordinates, LayoutKey& key);

/// The bodies that are merged to clusters, with their poses in the clusters.
struct MergedBodies {
  std::vector<int> frictions; ///< sticking joints that merge bodies, in addition to welds
  std::vector<Cluster> clusters;
  std::vector<Placement> placements; ///< per body
};
/// Returns the indices of the friction elements that stick and merge their two bodies.
[[nodiscard]] std::vector<int> merging_frictions(const System& system, const State& state);
/// Merges the bodies that stick rigidly in `state`, with the relative poses of `state`.
[[nodiscard]] MergedBodies merge_bodies(const System& system, const State& state);

/// Returns the layout for the friction phases of `state`. The relative poses of merged bodies are those in `merged`; without this argument,
/// those of `state`.
[[nodiscard]] Layout make_layout(const System& system, const State& state, Coordinates coordinates, const MergedBodies& merged);
[[nodiscard]] Layout make_layout(const System& system, const State& state, Coordinates coordinates = Coordinates::absolute);

} // namespace steplap
