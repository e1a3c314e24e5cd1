#include "elements/step_lap/patch/joined_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace steplap {

namespace {

constexpr std::size_t k_none = CellWorkspace::k_none;
// Largest distance, in rounding errors, between corresponding ends of one side that was clipped twice. The ends differ along the cut, the
// more the smaller the angle at which another edge crosses it. This is harmless: rings remain closed and on the lines of the edges.
constexpr double k_ends = 1e7;

bool is_apart(const Box& a, const Box& b) {
  return a.high.x() < b.low.x() || b.high.x() < a.low.x() || a.high.y() < b.low.y() || b.high.y() < a.low.y();
}

/// Returns true if the whole box is outside one side of the part. This excludes long oblique parts, whose own boxes are large.
bool has_outside(const Vec2* corners, std::size_t count, const Box& box) {
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2 &from = corners[i], along = corners[i + 1 == count ? 0 : i + 1] - from;
    const Vec2 innermost(along.y() > 0 ? box.low.x() : box.high.x(), along.x() > 0 ? box.high.y() : box.low.y());
    if (cross(along, innermost - from) < 0) return true;
  }
  return false;
}

class Joiner {
public:
  Joiner(const ConvexCut& a, const ConvexCut& b, double rounding, CellWorkspace& w) : a_(a), b_(b), rounding_(rounding), w_(w) {}

  void make_cells() {
    w_.cells.clear();
    w_.corners.clear();
    w_.cell_at.clear();
    w_.boxes.resize(b_.parts.size());
    for (std::size_t j = 0; j < b_.parts.size(); ++j) w_.boxes[j] = box_of(&w_.placed[b_.parts[j].first], b_.parts[j].count);
    if (w_.cell_of.size() < a_.parts.size() * b_.parts.size()) w_.cell_of.resize(a_.parts.size() * b_.parts.size(), k_none);
    for (std::size_t i = 0; i < a_.parts.size(); ++i)
      for (std::size_t j = 0; j < b_.parts.size(); ++j)
        if (!is_apart(a_.parts[i].box, w_.boxes[j])) make_cell(i, j);
    w_.partner.assign(w_.corners.size(), k_none);
    w_.is_written.assign(w_.corners.size(), 0);
  }

  void find_partners() {
    for (const CellWorkspace::Cell& cell : w_.cells)
      for (std::size_t k = cell.first; k < cell.first + cell.count; ++k)
        if (w_.corners[k].side.beyond >= 0 && w_.partner[k] == k_none) find_partner(cell, k);
  }

  void write(double least_area, Region& out) {
    const std::size_t first = out.size();
    for (std::size_t k = 0; k < w_.corners.size(); ++k)
      if (w_.partner[k] == k_none && !w_.is_written[k]) write_ring(k, out);
    const auto is_none = [&](const Polygon& p) { return !(area(p) > least_area); };
    std::size_t kept = first;
    for (std::size_t i = first; i < out.size(); ++i)
      if (!is_none(out[i])) std::swap(out[kept++], out[i]);
    for (; out.size() > kept; out.pop_back()) put_away(out.back());
  }

  void put_away(Polygon& polygon) {
    for (Ring& hole : polygon.holes) w_.rings.push_back(std::move(hole));
    polygon.holes.clear();
    w_.polygons.push_back(std::move(polygon));
  }

  void clean_up() {
    for (const CellWorkspace::Cell& cell : w_.cells) slot(cell.parts[0], cell.parts[1]) = k_none;
  }

private:
  std::size_t& slot(std::size_t i, std::size_t j) { return w_.cell_of[i * b_.parts.size() + j]; }

  void make_cell(std::size_t i, std::size_t j) {
    const ConvexPart &p = a_.parts[i], &q = b_.parts[j];
    if (has_outside(&a_.corners[p.first], p.count, w_.boxes[j])) return;
    if (has_outside(&w_.placed[q.first], q.count, p.box)) return;
    clip({&a_.corners[p.first], &a_.sides[p.first], p.count}, {&w_.placed[q.first], &b_.sides[q.first], q.count}, w_.clip);
    const std::vector<Corner>& ring = w_.clip.ring;
    if (ring.size() < 3 || is_narrow(ring)) return;
    slot(i, j) = w_.cells.size();
    w_.cells.push_back({w_.corners.size(), ring.size(), {i, j}, w_.cells.size(), -1});
    w_.corners.insert(w_.corners.end(), ring.begin(), ring.end());
    w_.cell_at.insert(w_.cell_at.end(), ring.size(), w_.cells.size() - 1);
  }

  /// Returns true if the cell is narrower than the accuracy of its corners.
  [[nodiscard]] bool is_narrow(const std::vector<Corner>& ring) const {
    double twice_area = 0, length = 0;
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const Vec2 from = ring[i - 1].at - ring[0].at, to = ring[i].at - ring[0].at;
      twice_area += cross(from, to);
      length = std::max(length, to.lpNorm<1>());
    }
    return !(twice_area > 2 * rounding_ * length);
  }

  [[nodiscard]] std::size_t next(std::size_t k) const {
    const CellWorkspace::Cell& cell = w_.cells[w_.cell_at[k]];
    return k + 1 == cell.first + cell.count ? cell.first : k + 1;
  }

  [[nodiscard]] bool agree(std::size_t k, std::size_t l) const {
    return (w_.corners[k].at - w_.corners[l].at).lpNorm<Eigen::Infinity>() <= k_ends * rounding_;
  }

  /// Searches the copy of a side in the cell across the cut. The cell with more corners searches in the one with fewer.
  void find_partner(const CellWorkspace::Cell& cell, std::size_t k) {
    const Corner& c = w_.corners[k];
    const auto beyond = static_cast<std::size_t>(c.side.beyond);
    const std::size_t there = c.is_second ? slot(cell.parts[0], beyond) : slot(beyond, cell.parts[1]);
    if (there == k_none) return;
    const CellWorkspace::Cell& other = w_.cells[there];
    if (other.count > cell.count) return;
    for (std::size_t l = other.first; l < other.first + other.count; ++l) {
      const Corner& d = w_.corners[l];
      const bool is_it =
          d.is_second == c.is_second && d.side.edge == c.side.edge && w_.partner[l] == k_none && agree(k, next(l)) && agree(next(k), l);
      if (!is_it) continue;
      w_.partner[k] = l;
      w_.partner[l] = k;
      w_.cells[root(w_.cell_at[k])].root = root(there);
      return;
    }
  }

  std::size_t root(std::size_t cell) {
    while (w_.cells[cell].root != cell) cell = w_.cells[cell].root = w_.cells[w_.cells[cell].root].root;
    return cell;
  }

  /// Returns the next side along the boundary, skipping removed cuts.
  [[nodiscard]] std::size_t follow(std::size_t k) const {
    for (k = next(k); w_.partner[k] != k_none; k = next(w_.partner[k])) {}
    return k;
  }

  /// Writes the ring to which side `start` belongs. Edges divided by cuts are joined again. Cuts that remain are kept: the ring may turn
  /// back at the end of one and return along its other side.
  void write_ring(std::size_t start, Region& out) {
    const auto is_same = [&](std::size_t k, std::size_t l) {
      const Corner &c = w_.corners[k], &d = w_.corners[l];
      return c.side.beyond < 0 && c.is_second == d.is_second && c.side.edge == d.side.edge;
    };
    Ring ring = spare_ring();
    std::size_t k = start;
    do {
      w_.is_written[k] = 1;
      const std::size_t to = follow(k);
      if (!is_same(k, to)) ring.push_back(w_.corners[to].at);
      k = to;
    } while (k != start);
    if (ring.size() < 3) w_.rings.push_back(std::move(ring));
    else put_ring(std::move(ring), w_.cells[root(w_.cell_at[start])], out);
  }

  /// Adds a ring to the polygon of its component; the ring with the largest area is the outer one.
  void put_ring(Ring ring, CellWorkspace::Cell& cell, Region& out) {
    if (cell.polygon < 0) {
      cell.polygon = static_cast<int>(out.size());
      out.push_back(spare_polygon());
      w_.rings.push_back(std::exchange(out.back().outer, std::move(ring)));
      return;
    }
    Polygon& polygon = out[static_cast<std::size_t>(cell.polygon)];
    if (signed_area(ring) > signed_area(polygon.outer)) std::swap(ring, polygon.outer);
    polygon.holes.push_back(std::move(ring));
  }

  Ring spare_ring() {
    if (w_.rings.empty()) return {};
    Ring ring = std::move(w_.rings.back());
    w_.rings.pop_back();
    ring.clear();
    return ring;
  }

  Polygon spare_polygon() {
    if (w_.polygons.empty()) return {};
    Polygon polygon = std::move(w_.polygons.back());
    w_.polygons.pop_back();
    return polygon;
  }

  const ConvexCut &a_, &b_;
  double rounding_;
  CellWorkspace& w_;
};

} // namespace

void join_cells(const ConvexCut& a, const ConvexCut& b, double rounding, double least_area, CellWorkspace& w, Region& out) {
  Joiner joiner(a, b, rounding, w);
  joiner.make_cells();
  joiner.find_partners();
  joiner.write(least_area, out);
  joiner.clean_up();
}

void empty_keeping_storage(Region& out, CellWorkspace& w) {
  for (Polygon& polygon : out) {
    for (Ring& hole : polygon.holes) w.rings.push_back(std::move(hole));
    polygon.holes.clear();
    w.polygons.push_back(std::move(polygon));
  }
  out.clear();
}

} // namespace steplap
