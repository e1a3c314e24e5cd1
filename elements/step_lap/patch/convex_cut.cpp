#include "elements/step_lap/patch/convex_cut.h"

#include "elements/step_lap/patch/exact_triangulation.h"

#include <algorithm>
#include <map>

namespace steplap {

namespace {

constexpr double k_straight = 1e-9; // rad: corners whose angle deviates from π by less count as straight

/// One side of a part during merging: one of the two directed halves of an edge or of a cut.
struct Half {
  std::size_t from = 0;           ///< start vertex in the polygon
  std::size_t next = 0, prev = 0; ///< neighbouring halves of the same part
  std::size_t twin = 0;
  bool has_twin = false, is_gone = false;
};

class Merger {
public:
  explicit Merger(const Polygon& polygon) {
    add_ring(polygon.outer);
    for (const Ring& hole : polygon.holes) add_ring(hole);
    std::map<std::array<std::size_t, 2>, std::size_t> waiting; // halves whose twin is not found yet, by start and end vertex
    for (const auto& t : triangulated(polygon))
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t h = halves_.size(), first = h - i;
        halves_.push_back({t[i], first + (i + 1) % 3, first + (i + 2) % 3});
        const std::size_t to = t[(i + 1) % 3];
        if (const auto other = waiting.find({to, t[i]}); other != waiting.end()) {
          halves_[h].twin = other->second;
          halves_[other->second].twin = h;
          halves_[h].has_twin = halves_[other->second].has_twin = true;
        } else {
          waiting[{t[i], to}] = h;
        }
      }
  }

  /// Removes the cuts that convexity does not require, in the order of their length.
  void merge(bool longest_first) {
    std::vector<std::pair<double, std::size_t>> cuts;
    for (std::size_t h = 0; h < halves_.size(); ++h)
      if (halves_[h].has_twin && h < halves_[h].twin) {
        const double length = (points_[halves_[halves_[h].twin].from] - points_[halves_[h].from]).norm();
        cuts.emplace_back(longest_first ? -length : length, h);
      }
    std::sort(cuts.begin(), cuts.end());
    for (const auto& [length, h] : cuts)
      if (turns_left(h) && turns_left(halves_[h].twin)) take_out(h);
  }

  [[nodiscard]] ConvexCut cut() const {
    std::vector<int> part_of(halves_.size(), -1);
    int parts = 0;
    for (std::size_t h = 0; h < halves_.size(); ++h) {
      if (halves_[h].is_gone || part_of[h] >= 0) continue;
      for (std::size_t k = h; part_of[k] < 0; k = halves_[k].next) part_of[k] = parts;
      ++parts;
    }
    ConvexCut out;
    std::vector<bool> is_done(static_cast<std::size_t>(parts), false);
    for (std::size_t h = 0; h < halves_.size(); ++h)
      if (!halves_[h].is_gone && !is_done[static_cast<std::size_t>(part_of[h])]) {
        is_done[static_cast<std::size_t>(part_of[h])] = true;
        add_part(h, part_of, out);
      }
    return out;
  }

private:
  void add_ring(const Ring& ring) { points_.insert(points_.end(), ring.begin(), ring.end()); }

  /// Returns true if the corner at the start of this half remains convex after removing the half and its twin. A straight corner does not
  /// count, because clipping could not distinguish two collinear sides.
  [[nodiscard]] bool turns_left(std::size_t h) const {
    const Vec2& a = points_[halves_[halves_[h].prev].from];
    const Vec2& b = points_[halves_[h].from];
    const Vec2& c = points_[halves_[halves_[halves_[halves_[h].twin].next].next].from];
    return cross(b - a, c - b) > k_straight * (b - a).norm() * (c - b).norm();
  }

  void take_out(std::size_t h) {
    const std::size_t t = halves_[h].twin;
    const auto join = [&](std::size_t a, std::size_t b) {
      halves_[a].next = b;
      halves_[b].prev = a;
    };
    join(halves_[h].prev, halves_[t].next);
    join(halves_[t].prev, halves_[h].next);
    halves_[h].is_gone = halves_[t].is_gone = true;
  }

  void add_part(std::size_t start, const std::vector<int>& part_of, ConvexCut& out) const {
    ConvexPart part;
    part.first = out.corners.size();
    std::size_t h = start;
    do {
      const Half& half = halves_[h];
      out.corners.push_back(points_[half.from]);
      const std::size_t number = half.has_twin ? points_.size() + std::min(h, half.twin) : half.from;
      out.sides.push_back({static_cast<int>(number), half.has_twin ? part_of[half.twin] : -1});
      h = half.next;
    } while (h != start);
    part.count = out.corners.size() - part.first;
    part.box = box_of(&out.corners[part.first], part.count);
    out.parts.push_back(part);
  }

  Ring points_;
  std::vector<Half> halves_;
};

} // namespace

Box box_of(const Vec2* corners, std::size_t count) {
  Box box{corners[0], corners[0]};
  for (std::size_t i = 1; i < count; ++i) {
    box.low = box.low.cwiseMin(corners[i]);
    box.high = box.high.cwiseMax(corners[i]);
  }
  return box;
}

ConvexCut uncut(const Ring& ring) {
  ConvexCut out;
  out.corners = ring;
  for (std::size_t i = 0; i < ring.size(); ++i) out.sides.push_back({static_cast<int>(i), -1});
  out.parts.push_back({0, ring.size(), box_of(ring.data(), ring.size())});
  return out;
}

ConvexCut cut_into_convex(const Polygon& polygon) {
  Merger longest(polygon), shortest = longest;
  longest.merge(true);
  shortest.merge(false);
  ConvexCut a = longest.cut(), b = shortest.cut();
  return a.parts.size() <= b.parts.size() ? a : b;
}

} // namespace steplap
