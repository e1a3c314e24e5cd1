#include "elements/step_lap/patch/traced_overlap.h"

#include <cmath>
#include <utility>

namespace steplap {

namespace {

// Symbolic perturbation, in rounding errors of coordinates: where edges or corners coincide, decisions are made as if the second sheet were
// shifted by k_push in a direction that edges rarely have. A distance of up to k_nought counts as zero and gets the sign of the shift; a
// distance larger than twice the shift has its own sign; in between the sign is ambiguous. The rings are thus those of a nearby pose, with
// the corners of the true one; areas added by the shift have zero width.
constexpr double k_nought = 1, k_push = 100, k_margin = 2 * k_push;
constexpr double k_least_push = 0.1; // smallest component of the shift across an edge, relative to the shift
constexpr double k_film = 4;         // width in rounding errors below which a part is caused by the shift
constexpr double k_blur = 10;        // uncertainty of the position of a crossing, in rounding errors
const Vec2 k_push_directions[] = {{0.540302305868140, 0.841470984807897},
                                  {-0.588501117255346, 0.808496403819590}}; // directions of the shift: unit vectors at 1 and 2.2 rad

using Crossing = TraceWorkspace::Crossing;
using Order = TraceWorkspace::Order;

class Tracer {
public:
  Tracer(const BoundaryView& a, const BoundaryView& b, double rounding, const Vec2& push_direction, TraceWorkspace& w, CellWorkspace& spare)
      : sheets_{a, b}, rounding_(rounding), margin_(k_margin * rounding), push_(k_push * rounding * push_direction), w_(w), spare_(spare) {}

  bool find_crossings() {
    w_.crossings.clear();
    cross(BoxTree::k_root, BoxTree::k_root);
    return is_certain_ && sort(0) && sort(1);
  }

  bool trace(double least_area, Region& out) {
    w_.is_done.assign(w_.crossings.size(), 0);
    for (std::size_t c = 0; c < w_.crossings.size(); ++c)
      if (w_.crossings[c].first_enters && !w_.is_done[c] && !trace_from(c, least_area, out)) return false;
    for (const std::size_t sheet : {0u, 1u})
      for (const Boundary::Span& ring : sheets_[sheet].boundary->rings)
        if (!is_crossed(sheet, ring)) add_whole(sheet, ring, least_area, out);
    // With the shift a hole may touch several outer rings, so its ring is ambiguous.
    if (is_pushed_ && out.size() > 1 && !w_.holes.empty()) return false;
    while (!w_.holes.empty()) {
      Polygon* around = polygon_around(w_.holes.back().front(), out);
      if (!around) return false;
      around->holes.push_back(std::move(w_.holes.back()));
      w_.holes.pop_back();
    }
    return true;
  }

  void give_back_holes() {
    for (Ring& hole : w_.holes) spare_.rings.push_back(std::move(hole));
    w_.holes.clear();
  }

private:
  [[nodiscard]] const Vec2& corner(std::size_t sheet, std::size_t i) const { return (*sheets_[sheet].corners)[i]; }
  [[nodiscard]] std::size_t next(std::size_t sheet, std::size_t i) const { return sheets_[sheet].boundary->next[i]; }

  // --- crossings -----------------------------------------------------------------------------------------

  [[nodiscard]] bool are_apart(const Box& p, const Box& q) const {
    return p.high.x() + margin_ < q.low.x() || q.high.x() + margin_ < p.low.x() || p.high.y() + margin_ < q.low.y() ||
           q.high.y() + margin_ < p.low.y();
  }

  void cross(std::size_t p, std::size_t q) {
    const BoxTree &a = *sheets_[0].tree, &b = *sheets_[1].tree;
    if (!is_certain_ || are_apart(a.box(p), b.box(q))) return;
    if (a.is_leaf(p) && b.is_leaf(q)) return cross_leaves(p, q);
    if (b.is_leaf(q) || (!a.is_leaf(p) && p <= q)) {
      cross(2 * p, q);
      cross(2 * p + 1, q);
    } else {
      cross(p, 2 * q);
      cross(p, 2 * q + 1);
    }
  }

  void cross_leaves(std::size_t p, std::size_t q) {
    const BoxTree &a = *sheets_[0].tree, &b = *sheets_[1].tree;
    for (std::size_t i = a.first(p); i < a.end(p); ++i) {
      const Box one = edge_box(0, i);
      if (are_apart(one, b.box(q))) continue;
      for (std::size_t j = b.first(q); j < b.end(q); ++j)
        if (is_certain_ && !are_apart(one, edge_box(1, j))) cross_edges(i, j);
    }
  }

  [[nodiscard]] Box edge_box(std::size_t sheet, std::size_t i) const {
    const Vec2 &from = corner(sheet, i), &to = corner(sheet, next(sheet, i));
    return {from.cwiseMin(to), from.cwiseMax(to)};
  }

  /// Twice the area of the triangle of a point of one sheet and an edge of the other, without and with the shift.
  struct Side {
    double true_one, pushed;
    int sign; ///< 0: ambiguous
  };
  Side perturbed_orientation(const Vec2& along, const Vec2& from_edge, const Vec2& push) {
    const double size = along.lpNorm<1>(), d = steplap::cross(along, from_edge), by = steplap::cross(along, push);
    Side side{d, d + by, 0};
    if (std::abs(d) > margin_ * size) {
      side.sign = d > 0 ? 1 : -1;
    } else if (std::abs(d) <= k_nought * rounding_ * size && std::abs(by) > k_least_push * k_push * rounding_ * size) {
      side.sign = by > 0 ? 1 : -1;
      is_pushed_ = true;
    }
    return side;
  }

  void cross_edges(std::size_t i, std::size_t j) {
    const Vec2 &a = corner(0, i), &b = corner(1, j), &a_end = corner(0, next(0, i)), &b_end = corner(1, next(1, j));
    const Vec2 along_a = a_end - a, along_b = b_end - b;
    const Side a0 = perturbed_orientation(along_b, a - b, -push_), a1 = perturbed_orientation(along_b, a_end - b, -push_);
    if (a0.sign * a1.sign > 0) return;
    const Side b0 = perturbed_orientation(along_a, b - a, push_), b1 = perturbed_orientation(along_a, b_end - a, push_);
    if (b0.sign * b1.sign > 0) return;
    if (a0.sign * a1.sign * b0.sign * b1.sign == 0 || a1.sign == b1.sign) {
      is_certain_ = false;
      return;
    }
    const double across_a = a0.true_one - a1.true_one, across_b = b0.true_one - b1.true_one;
    const double blur = k_blur * rounding_;
    w_.crossings.push_back({{i, j},
                            {a0.pushed / across_a, b0.pushed / across_b},
                            {blur * along_b.lpNorm<1>() / std::abs(across_a), blur * along_a.lpNorm<1>() / std::abs(across_b)},
                            a + (a0.true_one / across_a) * along_a,
                            a1.sign > 0});
  }

  /// Sorts the crossings by edge and along each edge. Returns false if two are too close to each other.
  bool sort(std::size_t sheet) {
    Order& order = w_.orders[sheet];
    order.start.assign(sheets_[sheet].corners->size() + 1, 0);
    order.crossings.resize(w_.crossings.size());
    order.place.resize(w_.crossings.size());
    for (const Crossing& c : w_.crossings) ++order.start[c.edge[sheet] + 1];
    for (std::size_t i = 1; i < order.start.size(); ++i) order.start[i] += order.start[i - 1];
    // Each start advances to the end of its range while crossings are stored, and is then reset.
    for (std::size_t c = 0; c < w_.crossings.size(); ++c) order.crossings[order.start[w_.crossings[c].edge[sheet]]++] = c;
    for (std::size_t i = order.start.size() - 1; i > 0; --i) order.start[i] = order.start[i - 1];
    order.start[0] = 0;
    for (std::size_t i = 0; i + 1 < order.start.size(); ++i)
      if (!sort_edge(order, sheet, order.start[i], order.start[i + 1])) return false;
    for (std::size_t i = 0; i < order.crossings.size(); ++i) order.place[order.crossings[i]] = i;
    return true;
  }

  bool sort_edge(Order& order, std::size_t sheet, std::size_t first, std::size_t end) const {
    if (end - first < 2) return true;
    const auto at = [&](std::size_t c) -> const Crossing& { return w_.crossings[c]; };
    const auto from = order.crossings.begin() + static_cast<std::ptrdiff_t>(first);
    std::sort(from, from + static_cast<std::ptrdiff_t>(end - first),
              [&](std::size_t c, std::size_t d) { return at(c).share[sheet] < at(d).share[sheet]; });
    for (std::size_t i = first + 1; i < end; ++i) {
      const Crossing &c = at(order.crossings[i - 1]), &d = at(order.crossings[i]);
      if (!(d.share[sheet] - c.share[sheet] > c.blur[sheet] + d.blur[sheet])) return false;
    }
    return true;
  }

  // --- rings ---------------------------------------------------------------------------------------------

  /// Writes the ring through crossing `start`: follows the first boundary from where it enters the other sheet to where it leaves it, then
  /// the second boundary, and so on. Returns false if entries and exits do not alternate.
  bool trace_from(std::size_t start, double least_area, Region& out) {
    Ring ring = spare_ring();
    std::size_t c = start, sheet = 0;
    bool is_sound = true;
    do {
      w_.is_done[c] = 1;
      ring.push_back(w_.crossings[c].at);
      c = walk(sheet, c, ring);
      is_sound = w_.crossings[c].first_enters == (sheet == 1);
      sheet = 1 - sheet;
    } while (is_sound && c != start);
    if (is_sound) put(std::move(ring), least_area, out);
    else spare_.rings.push_back(std::move(ring));
    return is_sound;
  }

  /// Adds the corners along the sheet's boundary from a crossing up to the next one. Returns the next crossing.
  std::size_t walk(std::size_t sheet, std::size_t from, Ring& ring) const {
    const Order& order = w_.orders[sheet];
    std::size_t edge = w_.crossings[from].edge[sheet], place = order.place[from] + 1;
    while (place == order.start[edge + 1]) {
      edge = next(sheet, edge);
      ring.push_back(corner(sheet, edge));
      place = order.start[edge];
    }
    return order.crossings[place];
  }

  [[nodiscard]] bool is_crossed(std::size_t sheet, const Boundary::Span& ring) const {
    const std::vector<std::size_t>& start = w_.orders[sheet].start;
    return start[ring.first] != start[ring.first + ring.count];
  }

  /// Adds a ring without crossings if it is inside the other sheet. Such a ring is completely inside or outside, and farther from the other
  /// boundary than the margin, so one corner decides.
  void add_whole(std::size_t sheet, const Boundary::Span& span, double least_area, Region& out) {
    const Vec2 p = corner(sheet, span.first) + (sheet == 1 ? push_ : -push_);
    if (crossings_to_the_right(1 - sheet, BoxTree::k_root, p) % 2 == 0) return;
    Ring ring = spare_ring();
    for (std::size_t i = 0; i < span.count; ++i) ring.push_back(corner(sheet, span.first + i));
    put(std::move(ring), least_area, out);
  }

  [[nodiscard]] static bool is_to_the_right(const Vec2& from, const Vec2& to, const Vec2& p) {
    return (from.y() > p.y()) != (to.y() > p.y()) && (steplap::cross(to - from, p - from) > 0) == (to.y() > from.y());
  }

  [[nodiscard]] int crossings_to_the_right(std::size_t sheet, std::size_t node, const Vec2& p) const {
    const BoxTree& tree = *sheets_[sheet].tree;
    const Box& box = tree.box(node);
    if (p.y() < box.low.y() || p.y() > box.high.y() || p.x() > box.high.x()) return 0;
    if (!tree.is_leaf(node)) return crossings_to_the_right(sheet, 2 * node, p) + crossings_to_the_right(sheet, 2 * node + 1, p);
    int crossings = 0;
    for (std::size_t i = tree.first(node); i < tree.end(node); ++i)
      crossings += is_to_the_right(corner(sheet, i), corner(sheet, next(sheet, i)), p);
    return crossings;
  }

  void put(Ring ring, double least_area, Region& out) {
    const double area = signed_area(ring);
    if (std::abs(area) <= least_area || is_film(ring, area)) {
      spare_.rings.push_back(std::move(ring));
    } else if (area < 0) {
      w_.holes.push_back(std::move(ring));
    } else {
      out.push_back(spare_polygon());
      spare_.rings.push_back(std::exchange(out.back().outer, std::move(ring)));
    }
  }

  /// Returns true if the ring encloses an area only because of the shift.
  [[nodiscard]] bool is_film(const Ring& ring, double area) const {
    if (!is_pushed_) return false;
    double length = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) length += (ring[i + 1 == ring.size() ? 0 : i + 1] - ring[i]).lpNorm<1>();
    return std::abs(area) <= k_film * rounding_ * length;
  }

  /// Returns the smallest outer ring around the point (of several, if an island lies in a hole).
  static Polygon* polygon_around(const Vec2& p, Region& out) {
    if (out.size() == 1) return &out.front();
    Polygon* found = nullptr;
    for (Polygon& polygon : out) {
      const Ring& ring = polygon.outer;
      int crossings = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) crossings += is_to_the_right(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1], p);
      if (crossings % 2 == 1 && (!found || signed_area(ring) < signed_area(found->outer))) found = &polygon;
    }
    return found;
  }

  Ring spare_ring() {
    if (spare_.rings.empty()) return {};
    Ring ring = std::move(spare_.rings.back());
    spare_.rings.pop_back();
    ring.clear();
    return ring;
  }

  Polygon spare_polygon() {
    if (spare_.polygons.empty()) return {};
    Polygon polygon = std::move(spare_.polygons.back());
    spare_.polygons.pop_back();
    return polygon;
  }

  BoundaryView sheets_[2];
  double rounding_, margin_;
  Vec2 push_;
  TraceWorkspace& w_;
  CellWorkspace& spare_;
  bool is_certain_ = true, is_pushed_ = false;
};

} // namespace

bool trace_overlap(const BoundaryView& a, const BoundaryView& b, double rounding, double least_area, TraceWorkspace& w,
                   CellWorkspace& spare, Region& out) {
  for (const Vec2& push_direction : k_push_directions) {
    Tracer tracer(a, b, rounding, push_direction, w, spare);
    if (tracer.find_crossings() && tracer.trace(least_area, out)) return true;
    tracer.give_back_holes();
    empty_keeping_storage(out, spare);
  }
  return false;
}

} // namespace steplap
