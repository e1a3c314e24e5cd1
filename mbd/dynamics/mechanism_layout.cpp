#include "mbd/dynamics/mechanism_layout.h"

#include "mbd/system/one_sided_row.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace steplap {

namespace {

// A pin or a distance joint between two clusters.
struct Hinge {
  int block = 0;
  int cluster[2] = {-1, -1};
  Vec2 point[2];       // relative to the centres of the clusters, in their axes; a position for the ground
  double length = 0.0; // length of a distance joint; 0: pin
};

class Islands {
public:
  explicit Islands(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) {
    if (i < 0 || j < 0) return;
    i = root(i), j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

private:
  std::vector<int> parent_;
};

bool is_pin(const System& system, const RowBlock& block) {
  if (block.count != 2) return false;
  const RowSpec &x = system.rows[block.first], &y = system.rows[block.first + 1];
  const bool are_fixed = !x.drive && !y.drive && x.base < 0 && y.base < 0;
  return are_fixed && x.kind == MeasureKind::axis && y.kind == MeasureKind::axis && x.a == y.a && x.b == y.b && x.point_a == y.point_a &&
         x.point_b == y.point_b && std::abs(x.direction.x() * y.direction.y() - x.direction.y() * y.direction.x()) > 0.5;
}

bool is_rod(const System& system, const RowBlock& block) {
  const RowSpec& row = system.rows[block.first];
  return block.count == 1 && row.kind == MeasureKind::distance && !row.drive && row.base >= 0;
}

class Finder {
public:
  Finder(const System& system, const State& state, const Layout& layout, Coordinates choice)
      : system_(system), state_(state), layout_(layout), choice_(choice), islands_(layout.clusters.size()),
        rows_(layout.clusters.size(), 0), hinges_at_(layout.clusters.size()), is_driven_(layout.clusters.size(), 0),
        is_long_(clusters_on_long_rows(system, layout)), member_(layout.clusters.size(), -1) {}

  JointCoordinates find(const std::vector<char>& is_block_merged, const std::vector<char>& is_friction_merged) {
    found_.mechanism_of.assign(layout_.clusters.size(), -1);
    found_.is_pin.assign(system_.row_blocks.size(), 0);
    connect(is_block_merged, is_friction_merged);
    std::vector<std::vector<int>> clusters(layout_.clusters.size());
    for (int k = 0; k < layout_.cluster_count(); ++k) clusters[islands_.root(k)].push_back(k);
    for (const std::vector<int>& island : clusters)
      if (!island.empty()) consider(island);
    return std::move(found_);
  }

private:
  [[nodiscard]] int cluster_of(int body) const { return layout_.placements[body].cluster; }

  [[nodiscard]] Vec2 on_cluster(int body, const Vec2& point) const {
    const Placement& place = layout_.placements[body];
    if (place.cluster < 0 || place.is_alone) return point;
    return place.offset + Vec2(place.c * point.x() - place.s * point.y(), place.s * point.x() + place.c * point.y());
  }

  void connect(const std::vector<char>& is_block_merged, const std::vector<char>& is_friction_merged) {
    const auto add_row = [this](const RowSpec& row) {
      const int a = cluster_of(row.a), b = cluster_of(row.b);
      islands_.join(a, b);
      ++rows_[a >= 0 ? a : b];
    };
    for (int i = 0; i < static_cast<int>(system_.row_blocks.size()); ++i) {
      const RowBlock& block = system_.row_blocks[i];
      const RowSpec& first = system_.rows[block.first];
      const int a = cluster_of(first.a), b = cluster_of(first.b);
      if (is_block_merged[i] || a == b) continue;
      for (int r = block.first; r < block.first + block.count; ++r) add_row(system_.rows[r]);
      if (block.coordinate >= 0) is_driven_[a] = 1;
      if (is_pin(system_, block) || is_rod(system_, block)) add_hinge(i, first);
    }
    for (std::size_t f = 0; f < system_.frictions.size(); ++f) {
      if (is_friction_merged[f] || state_.friction[f].phase != FrictionPhase::stick) continue;
      const FrictionElement& friction = *system_.frictions[f].friction;
      for (int r = 0; r < friction.dimension(); ++r)
        if (const RowSpec& row = friction.rows(state_.friction[f])[r]; cluster_of(row.a) >= 0 || cluster_of(row.b) >= 0) add_row(row);
    }
  }

  void add_hinge(int block, const RowSpec& row) {
    Hinge hinge;
    hinge.block = block;
    if (row.kind == MeasureKind::distance) hinge.length = state_.bases[row.base].value;
    const int body[2] = {row.a, row.b};
    for (int side = 0; side < 2; ++side) {
      hinge.cluster[side] = cluster_of(body[side]);
      hinge.point[side] = on_cluster(body[side], side == 0 ? row.point_a : row.point_b);
      if (hinge.cluster[side] >= 0) hinges_at_[hinge.cluster[side]].push_back(static_cast<int>(hinges_.size()));
    }
    if (row.kind != MeasureKind::distance || hinge.length > 0.0) hinges_.push_back(hinge);
    else
      for (const int k : hinge.cluster)
        if (k >= 0) hinges_at_[k].pop_back();
  }

  // Builds the tree of an island and keeps it if joint coordinates are suitable. Breadth-first search over pins from the ground, then over
  // a rod or from a free member to clusters that pins do not reach.
  void consider(const std::vector<int>& island) {
    if (island.size() > static_cast<std::size_t>(Mechanism::k_most)) return; // each cluster needs at least one coordinate
    for (const int k : island)
      if (is_driven_[k] != 0 || is_long_[k] != 0) return;
    tree_ = Mechanism();
    used_.clear();
    reached_.clear();
    for (const int k : island)
      for (const int h : hinges_at_[k]) hang_on_ground(h, k, false);
    for (std::size_t next = 0; reached_.size() < island.size() || next < reached_.size();) {
      if (next < reached_.size()) hang_all_on(reached_[next++]);
      else if (!hang_by_rod(island)) add_free(most_hinged(island));
    }
    int coordinates = 0, rows = 0;
    for (const Member& m : tree_.members) {
      coordinates += m.is_free ? 3 : 1;
      if (m.is_free && choice_ == Coordinates::automatic) return;
    }
    for (const int k : island) rows += rows_[k];
    for (const int block : used_) rows -= system_.row_blocks[block].count;
    if (used_.empty() || coordinates > Mechanism::k_most || rows > Mechanism::k_most) return;
    // There are at least as many rows as coordinates, and yet the mechanism can move, so some rows are redundant. The fewer rows remain,
    // the more sensitive the distribution of loads becomes to rounding. (Model redundant_loop: reactions accurate to 1e-5 instead of 1e-6
    // within a step.)
    if (rows >= coordinates && choice_ == Coordinates::automatic) return;
    tree_.row_count = rows;
    for (const int k : island) found_.mechanism_of[k] = static_cast<int>(found_.mechanisms.size());
    for (const int block : used_) found_.is_pin[block] = 1;
    found_.mechanisms.push_back(std::move(tree_));
  }

  void hang_on_ground(int h, int cluster, bool by_rod) {
    const Hinge& hinge = hinges_[h];
    if (member_[cluster] >= 0 || (hinge.length > 0.0) != by_rod) return;
    for (int side = 0; side < 2; ++side)
      if (hinge.cluster[side] == cluster && hinge.cluster[1 - side] < 0) hang(hinge, side);
  }

  void hang_all_on(int cluster) {
    for (const int h : hinges_at_[cluster]) {
      const Hinge& hinge = hinges_[h];
      const int side = hinge.cluster[0] == cluster ? 1 : 0;
      if (hinge.length == 0.0 && hinge.cluster[side] >= 0 && member_[hinge.cluster[side]] < 0) hang(hinge, side);
    }
  }

  bool hang_by_rod(const std::vector<int>& island) {
    for (const int k : island) {
      if (member_[k] >= 0) continue;
      for (const int h : hinges_at_[k]) {
        const Hinge& hinge = hinges_[h];
        const int side = hinge.cluster[0] == k ? 0 : 1, other = hinge.cluster[1 - side];
        if (hinge.length == 0.0 || (other >= 0 && member_[other] < 0)) continue;
        hang(hinge, side);
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] int most_hinged(const std::vector<int>& island) const {
    int best = -1;
    for (const int k : island)
      if (member_[k] < 0 && (best < 0 || hinges_at_[k].size() > hinges_at_[best].size())) best = k;
    return best;
  }

  Member cluster_member(int cluster) {
    Member m;
    m.cluster = cluster;
    m.slot = layout_.clusters[cluster].motion;
    m.mass = layout_.clusters[cluster].mass;
    m.inertia = layout_.clusters[cluster].inertia;
    member_[cluster] = static_cast<int>(tree_.members.size());
    reached_.push_back(cluster);
    return m;
  }

  void add_free(int cluster) {
    Member m = cluster_member(cluster);
    m.is_free = true;
    tree_.members.push_back(m);
  }

  // Makes the cluster on side `side` of a hinge a member, whose parent is the cluster on the other side, or the ground. A distance joint
  // adds a rod in between.
  void hang(const Hinge& hinge, int side) {
    const int on = hinge.cluster[1 - side];
    Pair<double> pin{hinge.point[1 - side].x(), hinge.point[1 - side].y()};
    int parent = -1;
    if (on >= 0) {
      parent = member_[on];
      pin = pin + tree_.members[parent].centre;
    }
    if (hinge.length > 0.0) {
      Member rod;
      rod.parent = parent;
      rod.pin = pin;
      parent = static_cast<int>(tree_.members.size());
      pin = {hinge.length, 0.0};
      tree_.members.push_back(rod);
    }
    Member m = cluster_member(hinge.cluster[side]);
    m.parent = parent;
    m.pin = pin;
    m.is_rod_end = hinge.length > 0.0;
    m.block = hinge.block;
    m.centre = {-hinge.point[side].x(), -hinge.point[side].y()};
    tree_.members.push_back(m);
    used_.push_back(hinge.block);
  }

  const System& system_;
  const State& state_;
  const Layout& layout_;
  Coordinates choice_;
  Islands islands_;
  std::vector<int> rows_;
  std::vector<Hinge> hinges_;
  std::vector<std::vector<int>> hinges_at_;
  std::vector<char> is_driven_;
  std::vector<char> is_long_;       // per cluster: a row over more than two bodies acts on it
  std::vector<int> member_;         // member index of each cluster
  std::vector<int> reached_, used_; // clusters and row blocks in tree_
  Mechanism tree_;
  JointCoordinates found_;
};

} // namespace

std::vector<char> clusters_on_long_rows(const System& system, const Layout& layout) {
  std::vector<char> is_long(layout.clusters.size(), 0);
  for (const OneSidedUnit& rope : one_sided_rows(system)) {
    if (!rope.row->is_long()) continue;
    rope.row->for_parts([&](const RowSpec& part) {
      for (const int body : {part.a, part.b})
        if (const int k = layout.placements[body].cluster; k >= 0) is_long[k] = 1;
    });
  }
  return is_long;
}

JointCoordinates find_joint_coordinates(const System& system, const State& state, const Layout& layout, Coordinates choice,
                                        const std::vector<char>& is_block_merged, const std::vector<char>& is_friction_merged) {
  return Finder(system, state, layout, choice).find(is_block_merged, is_friction_merged);
}

} // namespace steplap
