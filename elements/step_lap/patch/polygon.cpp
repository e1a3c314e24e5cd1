#include "elements/step_lap/patch/polygon.h"

#include "elements/step_lap/patch/exact_polygon.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

namespace steplap {

namespace {

// Distance, relative to the ring's extent, of a vertex from the line through its neighbours below which the vertex is dropped: it encloses
// no area that double precision resolves (2^-52 = 2.2e-16, a few rounding errors).
constexpr double k_collinear = 1e-15;

/// Twice the area and six times the first moment of a ring about `origin`.
struct RingSums {
  double area2 = 0;
  Vec2 moment6 = Vec2::Zero();
};

RingSums sums_about(const Ring& ring, const Vec2& origin) {
  RingSums sums;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = ring[i] - origin;
    const Vec2 b = ring[i + 1 == ring.size() ? 0 : i + 1] - origin;
    const double c = cross(a, b);
    sums.area2 += c;
    sums.moment6 += c * (a + b);
  }
  return sums;
}

void add_sums(RingSums& sums, const Polygon& polygon, const Vec2& origin) {
  const auto add = [&](const Ring& ring) {
    const RingSums s = sums_about(ring, origin);
    sums.area2 += s.area2;
    sums.moment6 += s.moment6;
  };
  add(polygon.outer);
  for (const Ring& hole : polygon.holes) add(hole);
}

/// A ring whose vertices keep their index in the input, for messages.
struct TracedRing {
  std::string name;
  Ring ring;
  std::vector<std::size_t> from;
};

double extent(const Ring& ring) {
  Vec2 low = ring.front(), high = ring.front();
  for (const Vec2& p : ring) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return (high - low).norm();
}

/// Returns true if vertex b between a and c is redundant: repeated, on the line, or the tip of a spike.
bool is_idle(const Vec2& a, const Vec2& b, const Vec2& c, double size) {
  const double longest = std::max((b - a).norm(), (c - b).norm());
  return (b - a).norm() <= k_collinear * size || (c - b).norm() <= k_collinear * size ||
         std::abs(cross(b - a, c - b)) <= k_collinear * size * longest;
}

std::string vertex_name(const TracedRing& r, std::size_t i) {
  std::ostringstream name; // six digits, because positions may differ by micrometres
  name << "vertex " << r.from[i] << " (" << r.ring[i].x() << ", " << r.ring[i].y() << ")";
  return name.str();
}

TracedRing without_idle_vertices(const Ring& input, const std::string& name) {
  TracedRing out;
  out.name = name;
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (!input[i].allFinite()) throw PolygonError(name + ": vertex " + std::to_string(i) + " is not a finite number");
    out.ring.push_back(input[i]);
    out.from.push_back(i);
  }
  const double size = input.empty() ? 0.0 : extent(input);
  for (bool again = true; again && out.ring.size() >= 3;) {
    again = false;
    for (std::size_t i = 0; i < out.ring.size() && out.ring.size() >= 3;) {
      const std::size_t n = out.ring.size();
      if (is_idle(out.ring[(i + n - 1) % n], out.ring[i], out.ring[(i + 1) % n], size)) {
        out.ring.erase(out.ring.begin() + static_cast<std::ptrdiff_t>(i));
        out.from.erase(out.from.begin() + static_cast<std::ptrdiff_t>(i));
        again = true;
      } else {
        ++i;
      }
    }
  }
  if (out.ring.size() < 3)
    throw PolygonError(name + ": has no area" + (input.empty() ? "" : ", with " + vertex_name({name, input, {0}}, 0)) +
                       "; it needs three vertices that are not on one line");
  return out;
}

/// Makes the ring counter-clockwise if `ccw`, otherwise clockwise.
void orient(TracedRing& traced, bool ccw) {
  if ((signed_area(traced.ring) > 0) == ccw) return;
  std::reverse(traced.ring.begin(), traced.ring.end());
  std::reverse(traced.from.begin(), traced.from.end());
}

std::string edge_name(const TracedRing& r, std::size_t edge) {
  const std::size_t next = edge + 1 == r.ring.size() ? 0 : edge + 1;
  return "the edge from " + vertex_name(r, edge) + " to " + vertex_name(r, next);
}

void require_simple(const std::vector<TracedRing>& rings) {
  std::vector<Ring> plain;
  for (const TracedRing& r : rings) plain.push_back(r.ring);
  if (const auto clash = find_clash(plain)) {
    const auto [a, b, ea, eb] = *clash;
    throw PolygonError(rings[a].name + ": " + edge_name(rings[a], ea) + " meets " + (a == b ? std::string() : rings[b].name + "'s ") +
                       edge_name(rings[b], eb) + (a == b ? "; a ring must not cross or touch itself" : "; rings must not cross or touch"));
  }
  for (std::size_t i = 1; i < rings.size(); ++i)
    if (!is_inside(plain[i].front(), plain[0]))
      throw PolygonError(rings[i].name + ": lies outside the outer ring, with " + vertex_name(rings[i], 0));
  for (std::size_t i = 1; i < rings.size(); ++i)
    for (std::size_t j = 1; j < rings.size(); ++j)
      if (i != j && is_inside(plain[i].front(), plain[j]))
        throw PolygonError(rings[i].name + ": lies inside " + rings[j].name + ", with " + vertex_name(rings[i], 0));
}

} // namespace

double signed_area(const Ring& ring) { return ring.empty() ? 0.0 : 0.5 * sums_about(ring, ring.front()).area2; }

double area(const Polygon& polygon) {
  double sum = signed_area(polygon.outer);
  for (const Ring& hole : polygon.holes) sum += signed_area(hole);
  return sum;
}

double area(const Region& region) {
  double sum = 0;
  for (const Polygon& polygon : region) sum += area(polygon);
  return sum;
}

Vec2 centroid(const Polygon& polygon) {
  RingSums sums;
  const Vec2 origin = polygon.outer.front(); // moments about a corner, so that no accuracy is lost far from the origin
  add_sums(sums, polygon, origin);
  return origin + sums.moment6 / (3.0 * sums.area2);
}

Vec2 centroid(const Region& region) {
  RingSums sums;
  const Vec2 origin = region.front().outer.front();
  for (const Polygon& polygon : region) add_sums(sums, polygon, origin);
  return origin + sums.moment6 / (3.0 * sums.area2);
}

bool is_convex(const Ring& ring) {
  // Left turns at all corners are not sufficient (a pentagram): the direction of x may change only twice.
  const std::size_t n = ring.size();
  int flips = 0;
  double last = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 e = ring[(i + 1) % n] - ring[i];
    const Vec2 f = ring[(i + 2) % n] - ring[(i + 1) % n];
    if (cross(e, f) < 0) return false;
    if (e.x() != 0) {
      flips += last * e.x() < 0;
      last = e.x() > 0 ? 1.0 : -1.0;
    }
  }
  return n >= 3 && flips <= 2;
}

Polygon repaired(Polygon polygon, const std::vector<std::string>& hole_names) {
  std::vector<TracedRing> rings;
  rings.push_back(without_idle_vertices(polygon.outer, "outer ring"));
  orient(rings[0], true);
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) {
    const std::string name = i < hole_names.size() ? hole_names[i] : "hole " + std::to_string(i);
    rings.push_back(without_idle_vertices(polygon.holes[i], name));
    orient(rings.back(), false);
  }
  require_simple(rings);
  polygon.outer = std::move(rings[0].ring);
  for (std::size_t i = 0; i < polygon.holes.size(); ++i) polygon.holes[i] = std::move(rings[i + 1].ring);
  return polygon;
}

} // namespace steplap
