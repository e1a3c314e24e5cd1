#include "mbd/dynamics/layout.h"

#include "mbd/base/portable_math.h"
#include "mbd/dynamics/mechanism_layout.h"
#include "mbd/dynamics/stage_program.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace steplap {

namespace {

// Distance below which two centres of gravity coincide, m: the rounding error of sums of metres.
constexpr double k_same_place = 1e-14;

// A rigid joint that may merge its two bodies, with its row block or friction element.
struct RigidJoint {
  int a, b, block, friction;
};

bool is_stuck(const State& state, int f) { return state.friction[f].phase == FrictionPhase::stick; }

// Returns all rigid joints: welds, and the friction elements listed in `frictions`, which merge their bodies.
std::vector<RigidJoint> rigid_joints(const System& system, const State& state, const std::vector<int>& frictions) {
  std::vector<RigidJoint> joints;
  for (int i = 0; i < static_cast<int>(system.row_blocks.size()); ++i) {
    const RowBlock& block = system.row_blocks[i];
    const RowSpec& row = system.rows[block.first];
    if (block.is_rigid) joints.push_back({row.a, row.b, i, -1});
  }
  for (const int f : frictions) {
    const RowSpec* rows = system.frictions[f].friction->rows(state.friction[f]);
    joints.push_back({rows[0].a, rows[0].b, -1, f});
  }
  return joints;
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Merges bodies. Returns for each joint whether it belongs to the spanning forest, without the ground. The others remain rows.
std::vector<char> merge(const System& system, const std::vector<RigidJoint>& joints, std::vector<int>& parent) {
  parent.resize(system.bodies.size());
  std::iota(parent.begin(), parent.end(), 0);
  std::vector<char> is_merged(joints.size(), 0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].a == k_ground || joints[i].b == k_ground) continue;
    const int ra = find_root(parent, joints[i].a), rb = find_root(parent, joints[i].b);
    if (ra == rb) continue;
    parent[std::max(ra, rb)] = std::min(ra, rb);
    is_merged[i] = 1;
  }
  return is_merged;
}

void make_clusters(const System& system, const State& state, std::vector<int>& parent, MergedBodies& merged) {
  const int n = system.body_count();
  merged.placements.assign(n, {});
  std::vector<int> cluster_of(n, -1);
  std::vector<int> size;
  for (int i = 1; i < n; ++i) {
    const int root = find_root(parent, i);
    if (root == i) {
      cluster_of[i] = static_cast<int>(merged.clusters.size());
      merged.clusters.push_back({});
      merged.clusters.back().root = i;
      size.push_back(0);
    }
    const int k = cluster_of[root];
    cluster_of[i] = k;
    merged.placements[i].cluster = k;
    merged.clusters[k].mass += system.bodies[i].mass;
    ++size[k];
  }
  std::vector<Vec2> centre(merged.clusters.size(), Vec2::Zero());
  for (int i = 1; i < n; ++i) {
    const int k = cluster_of[i];
    const Vec2 p(state.q[3 * i], state.q[3 * i + 1]);
    if (size[k] == 1) centre[k] = p;
    else centre[k] += system.bodies[i].mass / merged.clusters[k].mass * p;
  }
  for (int i = 1; i < n; ++i) {
    Cluster& cluster = merged.clusters[cluster_of[i]];
    Placement& place = merged.placements[i];
    place.is_alone = place.is_trivial = size[cluster_of[i]] == 1;
    cluster.inertia += system.bodies[i].inertia;
    if (place.is_alone) continue;
    const double root_angle = state.q[3 * cluster.root + 2];
    const Vec2 lever = Vec2(state.q[3 * i], state.q[3 * i + 1]) - centre[cluster_of[i]];
    place.offset = rotated(lever, -root_angle);
    place.angle = state.q[3 * i + 2] - root_angle;
    const portable::SinCos turn = portable::sin_cos(place.angle);
    place.c = turn.cos;
    place.s = turn.sin;
    cluster.inertia += system.bodies[i].mass * lever.squaredNorm();
  }
  for (Cluster& cluster : merged.clusters) {
    cluster.w[0] = cluster.w[1] = 1.0 / cluster.mass;
    cluster.w[2] = 1.0 / cluster.inertia;
  }
}

// Assigns slots to the motions of clusters: the slot of a body with the same motion, otherwise a new one after those of links.
void find_slots(const System& system, Layout& layout) {
  int extra = system.links.slot_count();
  for (Cluster& cluster : layout.clusters) {
    // The root body is often at the common centre of gravity, for example if limbs are on both sides of a core.
    Placement& root = layout.placements[cluster.root];
    if (root.offset.norm() < k_same_place) root.is_trivial = true;
    cluster.motion = root.is_trivial ? cluster.root : extra++;
    layout.slots.push_back(cluster.motion);
  }
  layout.slot_count = extra;
}

// Lists the edges of the spanning tree of each cluster, leaves first, as the reverse of breadth-first order from the root.
void order_edges(const std::vector<RigidJoint>& joints, const std::vector<char>& is_merged, int body_count, Layout& layout) {
  std::vector<std::vector<std::size_t>> at_body(body_count);
  for (std::size_t i = 0; i < joints.size(); ++i)
    if (is_merged[i]) {
      at_body[joints[i].a].push_back(i);
      at_body[joints[i].b].push_back(i);
    }
  std::vector<char> is_seen(body_count, 0);
  for (const Cluster& cluster : layout.clusters) {
    std::vector<int> queue{cluster.root};
    is_seen[cluster.root] = 1;
    for (std::size_t next = 0; next < queue.size(); ++next)
      for (const std::size_t i : at_body[queue[next]]) {
        const int other = joints[i].a == queue[next] ? joints[i].b : joints[i].a;
        if (is_seen[other]) continue;
        is_seen[other] = 1;
        layout.edges.push_back({queue[next], other, joints[i].block, joints[i].friction});
        layout.is_carried[other] = 1;
        queue.push_back(other);
      }
  }
  std::reverse(layout.edges.begin(), layout.edges.end());
}

RowPullKind pull_kind(const ActiveRow& row, const SchurRow& schur) {
  if (schur.body[0] < 0) return RowPullKind::other;
  if (row.spec->kind == MeasureKind::angle) return RowPullKind::angle;
  if (!row.is_simple) return RowPullKind::other;
  if (row.spec->kind == MeasureKind::axis) return RowPullKind::axis;
  if (row.spec->kind == MeasureKind::slide && row.spec->is_axis_in_a) return RowPullKind::slide;
  return RowPullKind::other;
}

void add_active(Layout& layout, const ActiveRow& row) {
  SchurRow schur;
  schur.body[0] = layout.placements[row.spec->a].cluster;
  schur.body[1] = layout.placements[row.spec->b].cluster;
  layout.active.push_back(row);
  for (const int body : {row.spec->a, row.spec->b}) {
    const Placement& place = layout.placements[body];
    if (place.cluster >= 0 && !place.is_trivial) layout.active.back().is_simple = false;
  }
  layout.schur_rows.push_back(schur);
  layout.active.back().pull = pull_kind(layout.active.back(), schur);
  if (row.spec->drive) layout.driven_rows.push_back(static_cast<int>(layout.active.size()) - 1);
}

// Sorts bilateral constraints. One that prescribes a coordinate of a single body locks that coordinate; those of all others are added to
// `wanted`, the rows to be made.
void want_bilateral(const System& system, const std::vector<char>& is_block_merged, const std::vector<char>& is_pin, Layout& layout,
                    std::vector<ActiveRow>& wanted) {
  for (int i = 0; i < static_cast<int>(system.row_blocks.size()); ++i) {
    const RowBlock& block = system.row_blocks[i];
    if (is_block_merged[i] || is_pin[i] != 0) continue;
    const RowSpec& first = system.rows[block.first];
    const Placement& place = layout.placements[first.a];
    if (place.cluster >= 0 && place.cluster == layout.placements[first.b].cluster) {
      layout.redundant_blocks.push_back(i);
      continue;
    }
    const bool is_free = block.coordinate >= 0 && place.is_alone && layout.clusters[place.cluster].w[block.coordinate] > 0.0;
    if (is_free) {
      layout.clusters[place.cluster].w[block.coordinate] = 0.0;
      layout.locks.push_back(
          {place.cluster, block.coordinate, block.first, block.coordinate < 2 ? first.point_b[block.coordinate] : 0.0, {}});
      continue;
    }
    for (int r = block.first; r < block.first + block.count; ++r) wanted.push_back({&system.rows[r], r, -1, 0});
  }
}

void want_frictions(const System& system, const State& state, const std::vector<char>& is_friction_merged, Layout& layout,
                    std::vector<ActiveRow>& wanted) {
  for (int f = 0; f < static_cast<int>(system.frictions.size()); ++f) {
    if (is_friction_merged[f]) {
      layout.merged.push_back(f);
      if (!system.frictions[f].friction->never_slips()) layout.can_merged_slip = true;
    } else if (is_stuck(state, f)) {
      layout.holding.push_back(f);
      const FrictionElement& friction = *system.frictions[f].friction;
      for (int r = 0; r < friction.dimension(); ++r) wanted.push_back({friction.rows(state.friction[f]) + r, -1, f, r});
    } else if (state.friction[f].phase == FrictionPhase::slip) {
      layout.sliding.push_back(f);
    }
  }
}

// Adds the active rows: those of absolute clusters, then those of each mechanism, otherwise in the order of `wanted`.
void add_rows(const System& system, std::vector<ActiveRow> wanted, Layout& layout) {
  const auto place_of = [&layout](const ActiveRow& row) {
    const int cluster = std::max(layout.placements[row.spec->a].cluster, layout.placements[row.spec->b].cluster);
    return cluster < layout.absolute_count ? -1 : layout.mechanism_of_cluster(cluster).first_cluster;
  };
  if (layout.has_mechanisms())
    std::stable_sort(wanted.begin(), wanted.end(), [&](const ActiveRow& a, const ActiveRow& b) { return place_of(a) < place_of(b); });
  for (const ActiveRow& row : wanted) {
    if (row.friction >= 0)
      layout.held_rows.push_back({static_cast<int>(layout.active.size()), system.frictions[row.friction].row + row.friction_row});
    add_active(layout, row);
  }
  auto row = layout.active.begin();
  while (layout.has_mechanisms() && row != layout.active.end() && place_of(*row) < 0) ++row;
  for (Mechanism& m : layout.mechanisms) { // mechanisms and their rows have the same order
    m.first_row = static_cast<int>(row - layout.active.begin());
    while (row != layout.active.end() && place_of(*row) == m.first_cluster) ++row;
    m.row_count = static_cast<int>(row - layout.active.begin()) - m.first_row;
  }
}

// Adds the further parts of rows over more than two bodies, after all rows.
void add_parts(Layout& layout) {
  for (std::size_t r = 0; r < layout.active.size(); ++r)
    for (const RowSpec* part = layout.active[r].spec->next; part; part = part->next) {
      SchurRow row;
      row.body[0] = layout.placements[part->a].cluster;
      row.body[1] = layout.placements[part->b].cluster;
      if (row.body[0] == row.body[1]) row.body[0] = row.body[1] = -1; // both bodies in one cluster: the part has no effect
      layout.parts.push_back({static_cast<int>(layout.schur_rows.size()), static_cast<int>(r)});
      layout.part_specs.push_back(part);
      layout.schur_rows.push_back(row);
    }
}

// Renumbers clusters such that those of mechanisms follow the others, with consecutive numbers in each mechanism.
void take_joint_coordinates(JointCoordinates found, Layout& layout) {
  std::vector<int> order(layout.clusters.size()), place(layout.clusters.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&found](int a, int b) { return found.mechanism_of[a] < found.mechanism_of[b]; });
  layout.absolute_count = 0;
  for (int i = static_cast<int>(order.size()) - 1; i >= 0; --i) {
    const int in = found.mechanism_of[order[i]];
    if (in >= 0) found.mechanisms[in].first_cluster = i;
    else if (layout.absolute_count == 0) layout.absolute_count = i + 1;
  }
  const std::vector<Cluster> clusters = layout.clusters;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = static_cast<int>(i);
    layout.clusters[i] = clusters[order[i]];
    layout.slots[i] = clusters[order[i]].motion;
  }
  for (Placement& p : layout.placements)
    if (p.cluster >= 0) p.cluster = place[p.cluster];
  for (Mechanism& m : found.mechanisms)
    for (Member& member : m.members)
      if (member.cluster >= 0) member.cluster = place[member.cluster];
  layout.mechanisms = std::move(found.mechanisms);
}

// Assigns coordinates: to absolute clusters first, then to mechanisms.
void number_coordinates(const System& system, Layout& layout) {
  int next = 3 * layout.absolute_count;
  for (int i = 0; i < next; ++i) layout.scales.push_back({i % 3 < 2, 0.0});
  for (Mechanism& m : layout.mechanisms) {
    const auto clusters = std::count_if(m.members.begin(), m.members.end(), [](const Member& k) { return k.cluster >= 0; });
    m.first_coordinate = next;
    m.close(static_cast<int>(clusters), system.gravity, layout.schur_rows.data() + m.first_row);
    for (int k = 0; k < m.size(); ++k) layout.scales.push_back({m.is_place(k), m.reach(k)});
    next += m.size();
  }
  layout.coordinate_count = next;
  layout.inverse_mass.resize(next, 1.0);
}

// Lists the links that an evaluation needs: those of force elements, and those of active rows.
void find_links(const System& system, const State& state, Layout& layout) {
  std::vector<char> is_needed(system.links.slot_count(), 0);
  for (int i = 0; i < system.force_link_count; ++i) is_needed[system.links.slot(i)] = 1;
  for (ActiveRow& row : layout.active) {
    row.link = system.links.slot_of(row.spec->a, row.spec->b);
    is_needed[row.link] = 1;
  }
  for (const int f : layout.sliding) {
    const RowSpec& row = *system.frictions[f].friction->rows(state.friction[f]);
    layout.sliding_link.push_back(system.links.slot_of(row.a, row.b));
    is_needed[layout.sliding_link.back()] = 1;
  }
  for (int i = 0; i < system.links.size(); ++i)
    if (is_needed[system.links.slot(i)]) layout.links.push_back({system.links.slot(i), system.links[i].a, system.links[i].b});
}

// Returns one row of each pin or rod that attaches a member of a mechanism.
std::vector<const RowSpec*> pin_rows(const System& system, const Layout& layout) {
  std::vector<const RowSpec*> rows;
  for (const Mechanism& mechanism : layout.mechanisms)
    for (const Member& m : mechanism.members)
      if (m.block >= 0) rows.push_back(&system.rows[system.row_blocks[m.block].first]);
  return rows;
}

void find_riding(const System& system, const State& state, Layout& layout) {
  std::vector<char> is_needed(system.bodies.size(), 0);
  for (const auto& group : system.groups) group->mark_bodies(is_needed);
  for (const ActiveRow& row : layout.active) is_needed[row.spec->a] = is_needed[row.spec->b] = 1;
  for (const RowSpec* part : layout.part_specs) is_needed[part->a] = is_needed[part->b] = 1;
  for (const int f : layout.sliding) {
    const RowSpec* rows = system.frictions[f].friction->rows(state.friction[f]);
    is_needed[rows[0].a] = is_needed[rows[0].b] = 1;
  }
  if (layout.is_carried_by_pins)
    for (const RowSpec* row : pin_rows(system, layout)) is_needed[row->a] = is_needed[row->b] = 1;
  for (int i = 1; i < system.body_count(); ++i)
    if (!layout.placements[i].is_trivial) (is_needed[i] ? layout.riding : layout.riding_along).push_back(i);
}

} // namespace

Layout::Layout() = default;
Layout::~Layout() = default;
Layout::Layout(Layout&&) noexcept = default;
Layout& Layout::operator=(Layout&&) noexcept = default;

void layout_key(const State& state, Coordinates coordinates, LayoutKey& key) {
  key.resize(state.friction.size() + 1);
  key.back() = static_cast<std::uint64_t>(coordinates);
  for (std::size_t i = 0; i + 1 < key.size(); ++i)
    key[i] = static_cast<std::uint64_t>(state.friction[i].phase) << 32 | state.friction[i].foot;
}

std::vector<int> merging_frictions(const System& system, const State& state) {
  std::vector<int> frictions;
  for (int f = 0; f < static_cast<int>(system.frictions.size()); ++f)
    if (is_stuck(state, f) && system.frictions[f].friction->is_rigid()) frictions.push_back(f);
  return frictions;
}

MergedBodies merge_bodies(const System& system, const State& state) {
  MergedBodies merged;
  merged.frictions = merging_frictions(system, state);
  std::vector<int> parent;
  static_cast<void>(merge(system, rigid_joints(system, state, merged.frictions), parent));
  make_clusters(system, state, parent, merged);
  return merged;
}

Layout make_layout(const System& system, const State& state, Coordinates coordinates) {
  return make_layout(system, state, coordinates, merge_bodies(system, state));
}

namespace {

// The row blocks and friction elements inside clusters, which need no rows.
struct MergedRows {
  std::vector<char> is_block, is_friction;
};

MergedRows merged_rows(const System& system, const std::vector<RigidJoint>& joints, const std::vector<char>& is_merged) {
  MergedRows rows{std::vector<char>(system.row_blocks.size(), 0), std::vector<char>(system.frictions.size(), 0)};
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!is_merged[i]) continue;
    if (joints[i].block >= 0) rows.is_block[joints[i].block] = 1;
    if (joints[i].friction >= 0) rows.is_friction[joints[i].friction] = 1;
  }
  return rows;
}

// Selects joint coordinates for small mechanisms. Returns for each row block whether it is a pin of a mechanism, which needs no rows.
std::vector<char> choose_coordinates(const System& system, const State& state, Coordinates coordinates, const MergedRows& merged,
                                     Layout& layout) {
  // Inner states require absolute coordinates, because Linearization stores them in blocks of clusters (Linearization::InnerBlock).
  if (coordinates == Coordinates::absolute || system.inner_count() != 0) return std::vector<char>(system.row_blocks.size(), 0);
  JointCoordinates found = find_joint_coordinates(system, state, layout, coordinates, merged.is_block, merged.is_friction);
  std::vector<char> is_pin = found.is_pin;
  if (!found.mechanisms.empty()) take_joint_coordinates(std::move(found), layout);
  return is_pin;
}

void find_carried_rows(const System& system, Layout& layout) {
  const auto is_carried = [&layout](const RowSpec& row) { return layout.is_carried[row.a] || layout.is_carried[row.b]; };
  for (const RowSpec* row : pin_rows(system, layout))
    if (is_carried(*row)) layout.is_carried_by_pins = true;
  for (std::size_t r = 0; r < layout.active.size(); ++r) {
    bool is_any = false;
    for (const RowSpec* part = layout.active[r].spec; part; part = part->next) is_any = is_any || is_carried(*part);
    if (is_any) layout.carried_rows.push_back(static_cast<int>(r));
  }
}

void weigh_clusters(const System& system, Layout& layout) {
  for (int k = 0; k < layout.absolute_count; ++k) {
    const Cluster& cluster = layout.clusters[k];
    layout.weight.insert(layout.weight.end(), {cluster.mass * system.gravity.x(), cluster.mass * system.gravity.y(), 0.0});
    layout.inverse_mass.insert(layout.inverse_mass.end(), cluster.w, cluster.w + 3);
  }
}

void find_lock_terms(Layout& layout) {
  for (Lock& lock : layout.locks) {
    const auto add_terms = [&](int r, int multiplier) {
      for (int side = 0; side < 2; ++side)
        if (layout.schur_rows[r].body[side] == lock.cluster) lock.terms.push_back({r, side, multiplier});
    };
    for (int r = 0; r < static_cast<int>(layout.active.size()); ++r) add_terms(r, r);
    for (const SchurPart& part : layout.parts) add_terms(part.row, part.of);
  }
}

// Sets the numbers of the rows that do not depend on the pose.
void fill_rows(Layout& layout) {
  // A row between two bodies of one cluster has no effect. With zero inverse masses it is recognised as dependent.
  for (SchurRow& row : layout.schur_rows)
    for (int side = 0; side < 2; ++side)
      if (row.body[side] >= 0 && row.body[0] != row.body[1]) std::copy_n(layout.clusters[row.body[side]].w, 3, row.w[side]);
  // The gradient of an angle is constant and is not computed again in evaluations.
  for (std::size_t r = 0; r < layout.active.size(); ++r) {
    if (layout.active[r].spec->kind != MeasureKind::angle) continue;
    SchurRow& row = layout.schur_rows[r];
    row.is_constant = true;
    row.j[0][2] = 1.0;
    row.j[1][2] = -1.0;
    for (int side = 0; side < 2; ++side) row.wj[side][2] = row.w[side][2] * row.j[side][2];
  }
}

void analyze_rows(Layout& layout) {
  int absolute_rows = static_cast<int>(layout.active.size());
  for (const Mechanism& m : layout.mechanisms) absolute_rows -= m.row_count;
  layout.schur.analyze(layout.schur_rows, absolute_rows, layout.parts, SchurSolver::HubElimination::apart);
}

} // namespace

Layout make_layout(const System& system, const State& state, Coordinates coordinates, const MergedBodies& merged) {
  Layout layout;
  layout_key(state, coordinates, layout.key);
  const std::vector<RigidJoint> joints = rigid_joints(system, state, merged.frictions);
  std::vector<int> parent;
  const std::vector<char> is_merged = merge(system, joints, parent);
  layout.clusters = merged.clusters;
  layout.placements = merged.placements;
  find_slots(system, layout);
  layout.absolute_count = layout.cluster_count();
  const MergedRows without_rows = merged_rows(system, joints, is_merged);
  const std::vector<char> is_pin = choose_coordinates(system, state, coordinates, without_rows, layout);
  layout.is_carried.assign(system.bodies.size(), 0);
  if (std::find(is_merged.begin(), is_merged.end(), 1) != is_merged.end()) order_edges(joints, is_merged, system.body_count(), layout);
  std::vector<ActiveRow> wanted;
  want_bilateral(system, without_rows.is_block, is_pin, layout, wanted);
  want_frictions(system, state, without_rows.is_friction, layout, wanted);
  add_rows(system, std::move(wanted), layout);
  add_parts(layout);
  find_carried_rows(system, layout);
  find_riding(system, state, layout);
  find_links(system, state, layout);
  weigh_clusters(system, layout);
  number_coordinates(system, layout);
  find_lock_terms(layout);
  fill_rows(layout);
  for (const ActiveRow& row : layout.active)
    layout.is_friction_row.push_back(row.friction >= 0 && !system.frictions[row.friction].friction->never_slips());
  layout.forget_sharing();
  analyze_rows(layout);
  return layout;
}

} // namespace steplap
