// The layout of a mode: which bodies move as one, which coordinates are driven, which rows hold.
//
// Bodies held rigidly together (welds, sticking step-lap joints) are merged into *clusters* that are
// integrated as one body about their common centre of gravity; a coordinate that a drive prescribes is
// locked (infinite mass); what remains are rows. A layout is found once for a set of modes.
#pragma once

#include "mbd/load_sharing.h"
#include "mbd/schur.h"
#include "mbd/system.h"

#include <memory>
#include <vector>

namespace steplap {

/// Several bodies moving as one; coordinates are those of its centre of gravity.
struct Cluster {
  double mass = 0.0, inertia = 0.0;
  double w[3] = {0, 0, 0}; ///< 1/m, 1/m, 1/J; 0 where locked
  int root = 0;            ///< the body whose angle it carries
  int motion = 0;          ///< slot of its motion: the body's own if it is alone, else an extra one
};

/// Place of a body in its cluster.
struct Placement {
  int cluster = -1;        ///< −1: the ground
  bool is_alone = true;    ///< the only body of its cluster
  bool is_trivial = true;  ///< it moves as its cluster does: alone, or placed at its centre of gravity
  Vec2 offset = Vec2::Zero(); ///< centre of gravity in the cluster's axes
  double angle = 0.0, c = 1.0, s = 0.0; ///< against the cluster's
};

/// Where the row comes from.
struct ActiveRow {
  const RowSpec* spec = nullptr;
  int row = -1;        ///< bilateral row, or −1
  int friction = -1;   ///< friction element and which of its rows, or −1
  int friction_row = 0;
  int link = 0;          ///< of the row's bodies
  bool is_simple = true; ///< both bodies are clusters of their own, or the ground
};

/// A driven coordinate of a cluster that consists of one body.
struct Lock {
  int cluster = 0, coordinate = 0;
  int row = 0; ///< the bilateral row it stands for
};

/// A link that an evaluation needs, with its bodies at hand.
struct ActiveLink {
  int link = 0, a = 0, b = 0;
};

/// A rigid joint inside a cluster: `child` hangs on `parent`; leaves first.
struct RigidEdge {
  int parent = 0, child = 0;
  int block = -1;    ///< row block, or −1
  int friction = -1; ///< friction element, or −1
};

struct Layout {
  std::vector<char> key;             ///< phases and places of friction it was made for
  std::vector<Cluster> clusters;
  std::vector<Placement> placements; ///< per body
  std::vector<int> placed;           ///< bodies whose motion an evaluation needs
  std::vector<char> is_placed;       ///< the same per body

  std::vector<ActiveRow> active;
  std::vector<Lock> locks;
  std::vector<double> weight, inverse_mass; ///< per cluster coordinate: m g and W
  std::vector<RigidEdge> edges;
  std::vector<char> is_carried;      ///< per body: child of an edge, whose wrench balance is wanted
  std::vector<int> carried_rows;     ///< active rows that act on such a body
  std::vector<int> redundant_blocks; ///< rigid blocks inside one cluster that close a loop
  std::vector<ActiveLink> links;
  std::vector<int> sliding;          ///< friction elements in phase slip
  std::vector<int> sliding_link;     ///< of each of those
  std::vector<int> holding;          ///< friction elements in phase stick that are not merged
  std::vector<int> merged;           ///< friction elements in phase stick that are merged
  bool is_merged_watched = false;    ///< some of those can slip, or sticking elements share a load
  std::unique_ptr<LoadSharing> sharing; ///< null until rows have been met that depend on each other
  std::vector<double> reference;     ///< clusters' coordinates in the reference pose, for error scales
  bool has_drives = false;           ///< some active row or lock moves with time
  SchurSolver schur;
  std::vector<SchurRow> schur_rows;  ///< bodies filled in, numbers are scratch

  [[nodiscard]] int cluster_count() const { return static_cast<int>(clusters.size()); }
};

/// Phases and places of friction, as a key of layouts.
[[nodiscard]] std::vector<char> layout_key(const State& state);

/// The layout for the friction phases and the poses in `state`.
[[nodiscard]] Layout make_layout(const System& system, const State& state);

} // namespace steplap
