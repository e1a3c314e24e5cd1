#include "mbd/dynamics/parts.h"

#include "mbd/dynamics/layout.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace steplap {

namespace {

// How far before its usual size a part may end, in clusters, where nothing reaches over the end.
constexpr int k_leeway = Parts::k_clusters / 2;

int cluster_of(const Layout& layout, int body) { return layout.placements[body].cluster; }

// Per place between two clusters in absolute coordinates: how many links and rows reach over it.
std::vector<int> reaching_over(const Layout& layout, int rows) {
  std::vector<int> change(layout.absolute_count + 2, 0);
  const auto enter = [&](int a, int b) {
    if (a < 0 || b < 0 || a == b) return;
    const int low = std::min({a, b, layout.absolute_count}), high = std::min(std::max(a, b), layout.absolute_count);
    ++change[low + 1];
    --change[high + 1];
  };
  for (const ActiveLink& link : layout.links) enter(cluster_of(layout, link.a), cluster_of(layout, link.b));
  for (int r = 0; r < rows; ++r) enter(layout.schur_rows[r].body[0], layout.schur_rows[r].body[1]);
  std::partial_sum(change.begin(), change.end(), change.begin());
  return change;
}

void divide_absolute(const Layout& layout, int rows, Parts& parts) {
  const std::vector<int> over = reaching_over(layout, rows);
  for (int from = 0; from < layout.absolute_count;) {
    const int most = from + Parts::k_clusters;
    int to = layout.absolute_count;
    if (to - from >= Parts::k_clusters + k_leeway) { // no small one at the end
      to = most;
      while (to > most - k_leeway && over[to] != 0) --to;
      if (over[to] != 0) to = most;
    }
    Part part;
    part.clusters = from;
    part.clusters_end = to;
    part.coordinates = 3 * from;
    part.coordinates_end = 3 * to;
    parts.parts.push_back(part);
    std::fill(parts.of_cluster.begin() + from, parts.of_cluster.begin() + to, parts.count() - 1);
    from = to;
  }
}

void divide_mechanisms(const Layout& layout, Parts& parts) {
  const int all = static_cast<int>(layout.mechanisms.size());
  for (int from = 0; from < all;) {
    const Mechanism& first = layout.mechanisms[from];
    int to = from;
    for (int clusters = 0; to < all && clusters < Parts::k_clusters; ++to) clusters += layout.mechanisms[to].cluster_count();
    const Mechanism& last = layout.mechanisms[to - 1];
    Part part;
    part.clusters = part.clusters_end = layout.absolute_count;
    part.mechanisms = from;
    part.mechanisms_end = to;
    part.coordinates = first.first_coordinate;
    part.coordinates_end = last.first_coordinate + last.size();
    parts.parts.push_back(part);
    std::fill(parts.of_cluster.begin() + first.first_cluster,
              parts.of_cluster.begin() + last.first_cluster + last.cluster_count(), parts.count() - 1);
    from = to;
  }
}

// The layout's links part by part, those inside a part first.
void order_links(Layout& layout, Parts& parts) {
  const auto part_of = [&](int body) { return cluster_of(layout, body) < 0 ? -1 : parts.of_cluster[cluster_of(layout, body)]; };
  const auto is_inside = [&](const ActiveLink& link) { return part_of(link.a) >= 0 && part_of(link.a) == part_of(link.b); };
  const auto place = [&](const ActiveLink& link) { return 2 * parts.of(layout, link.a, link.b) + (is_inside(link) ? 0 : 1); };
  std::stable_sort(layout.links.begin(), layout.links.end(),
                   [&](const ActiveLink& a, const ActiveLink& b) { return place(a) < place(b); });
  std::vector<int> owner(2 * layout.links.size(), -1);
  std::vector<int> count(2 * parts.count() + 1, 0);
  for (std::size_t i = 0; i < layout.links.size(); ++i) {
    const ActiveLink& link = layout.links[i];
    ++count[place(link)];
    if (is_inside(link)) continue;
    owner[2 * i] = part_of(link.a);
    owner[2 * i + 1] = part_of(link.b);
    if (owner[2 * i] >= 0 && owner[2 * i + 1] >= 0) parts.are_separate = false;
  }
  int next = 0;
  for (int p = 0; p < parts.count(); ++p) {
    Part& part = parts.parts[p];
    part.links = next;
    part.links_inside = part.links + count[2 * p];
    part.links_end = next = part.links_inside + count[2 * p + 1];
  }
  parts.link_sides = PartLists(parts.count(), owner);
}

void order_rows(const Layout& layout, int rows, Parts& parts) {
  std::vector<int> owner(rows, 0), side_owner(2 * owner.size(), -1);
  for (std::size_t r = 0; r < owner.size(); ++r) {
    const int* const body = layout.schur_rows[r].body;
    for (int side = 0; side < 2; ++side)
      if (body[side] >= 0) side_owner[2 * r + side] = parts.of_cluster[body[side]];
    owner[r] = std::max(0, body[0] >= 0 ? side_owner[2 * r] : side_owner[2 * r + 1]);
    if (body[0] >= 0 && body[1] >= 0 && side_owner[2 * r] != side_owner[2 * r + 1]) parts.are_separate = false;
  }
  parts.rows = PartLists(parts.count(), owner);
  parts.row_sides = PartLists(parts.count(), side_owner);
  parts.of_row = std::move(owner);
}

void order_bodies(const System& system, Layout& layout, Parts& parts) {
  std::vector<int> riding(system.bodies.size(), -1), locks, sliding;
  for (const int i : layout.riding) riding[i] = parts.of_cluster[cluster_of(layout, i)];
  for (const Lock& lock : layout.locks) locks.push_back(parts.of_cluster[lock.cluster]);
  for (const int f : layout.sliding) {
    const RowSpec& row = *system.frictions[f].friction->rows({}); // the same two bodies at each of its places
    sliding.push_back(parts.of(layout, row.a, row.b));
  }
  parts.riding = PartLists(parts.count(), riding);
  parts.locks = PartLists(parts.count(), locks);
  parts.sliding = PartLists(parts.count(), sliding);
}

void divide_groups(const System& system, const Layout& layout, Parts& parts) {
  for (std::size_t g = 0; g < system.groups.size(); ++g) {
    const ForceGroup& group = *system.groups[g];
    std::vector<int> owner(group.divisible_count());
    for (std::size_t i = 0; i < owner.size(); ++i) {
      const Link pair = group.link_of(static_cast<int>(i));
      owner[i] = parts.of(layout, pair.a, pair.b);
    }
    if (owner.empty()) parts.whole_groups.push_back(static_cast<int>(g));
    parts.elements.emplace_back(parts.count(), owner);
  }
}

} // namespace

PartLists::PartLists(int parts, const std::vector<int>& owner) : begin_(parts + 1, 0) {
  for (const int p : owner)
    if (p >= 0) ++begin_[p + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  items_.resize(begin_.back());
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < owner.size(); ++i)
    if (owner[i] >= 0) items_[next[owner[i]]++] = static_cast<int>(i);
}

int Parts::of(const Layout& layout, int a, int b) const {
  const int first = cluster_of(layout, a), second = cluster_of(layout, b);
  return first >= 0 ? of_cluster[first] : second >= 0 ? of_cluster[second] : 0;
}

std::unique_ptr<Parts> make_parts(const System& system, Layout& layout, int rows) {
  if (layout.cluster_count() < Parts::k_least_clusters || layout.has_long_rows()) return nullptr;
  auto parts = std::make_unique<Parts>();
  parts->of_cluster.assign(layout.clusters.size(), 0);
  divide_absolute(layout, rows, *parts);
  divide_mechanisms(layout, *parts);
  order_links(layout, *parts);
  order_rows(layout, rows, *parts);
  order_bodies(system, layout, *parts);
  divide_groups(system, layout, *parts);
  return parts;
}

} // namespace steplap
