#include "elements/step_lap/patch/convex_clip.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace steplap {

namespace {

std::size_t next(std::size_t i, std::size_t n) { return i + 1 == n ? 0 : i + 1; }

Corner corner(const RingView& ring, std::size_t i, bool is_second) {
  return {ring.corners[i], ring.sides ? ring.sides[i] : PartSide{}, is_second};
}

/// A clipping line; the part on its left is kept.
struct Cutter {
  Vec2 from, along;
  PartSide side;
  Cutter(const RingView& b, std::size_t i)
      : from(b.corners[i]), along(b.corners[next(i, b.count)] - b.corners[i]), side(b.sides ? b.sides[i] : PartSide{}) {}
  [[nodiscard]] double inwards(const Vec2& p) const { return cross(along, p - from); }
};

Vec2 crossing(const Vec2& from, double d_from, const Vec2& to, double d_to) { return from + (to - from) * (d_from / (d_from - d_to)); }

// --- few corners: edge by edge -----------------------------------------------------------------

/// Clips w.ring by one line. Returns false if nothing is left.
bool cut(const Cutter& by, ClipWorkspace& w) {
  const std::size_t n = w.ring.size();
  w.beyond.resize(n);
  bool is_any_out = false, is_any_in = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double d = w.beyond[i] = by.inwards(w.ring[i].at);
    is_any_out |= d < 0;
    is_any_in |= d > 0;
  }
  if (!is_any_in) return false;
  if (!is_any_out) return true;
  w.spare.clear();
  for (std::size_t i = n - 1, j = 0; j < n; i = j++) {
    const Corner &from = w.ring[i], &to = w.ring[j];
    const double d_from = w.beyond[i], d_to = w.beyond[j];
    if (d_from >= 0 && d_to < 0) w.spare.push_back({crossing(from.at, d_from, to.at, d_to), by.side, true});
    else if (d_from < 0 && d_to >= 0) w.spare.push_back({crossing(from.at, d_from, to.at, d_to), from.side, from.is_second});
    if (d_to >= 0) w.spare.push_back(to);
  }
  std::swap(w.ring, w.spare);
  return true;
}

void clip_few(const RingView& a, const RingView& b, ClipWorkspace& w) {
  w.ring.clear();
  for (std::size_t i = 0; i < a.count; ++i) w.ring.push_back(corner(a, i, false));
  for (std::size_t i = 0; i < b.count; ++i)
    if (!cut(Cutter(b, i), w)) return w.ring.clear();
}

// --- many corners: following the cuts -----------------------------------------------------------

class Walk {
public:
  Walk(const RingView& a, std::vector<ClipWorkspace::Link>& links) : links_(links) {
    links_.clear();
    for (std::size_t i = 0; i < a.count; ++i) links_.push_back({corner(a, i, false), next(i, a.count), i == 0 ? a.count - 1 : i - 1});
  }

  /// Moves to the corner farthest outside. Consecutive clipping lines turn to the left, and this corner moves in the same sense.
  void go_out(const Cutter& by, bool is_first) {
    double d = by.inwards(at(here_));
    if (is_first)
      for (std::size_t i = 1; i < links_.size(); ++i)
        if (const double there = by.inwards(at(i)); there < d) d = there, here_ = i;
    while (true) { // continues past very short sides, whose direction is rounding
      const std::size_t one = links_[here_].next, two = links_[one].next;
      const double d_one = by.inwards(at(one)), d_two = by.inwards(at(two));
      if (!(std::min(d_one, d_two) < d)) return;
      here_ = d_two < d_one ? two : one;
      d = std::min(d_one, d_two);
    }
  }

  /// Clips by one line. Returns false if nothing is left.
  bool cut(const Cutter& by) {
    if (by.inwards(at(here_)) >= 0) return true;
    std::size_t after = links_[here_].next, before = links_[here_].prev;
    for (; by.inwards(at(after)) < 0; after = links_[after].next)
      if (after == here_) return false;
    while (by.inwards(at(before)) < 0) before = links_[before].prev;
    const Corner out = links_[links_[after].prev].corner; // last corner outside
    const std::size_t start = links_.size(), end = start + 1;
    links_.push_back({{between(by, before, links_[before].next), by.side, true}, end, before});
    links_.push_back({{between(by, links_[after].prev, after), out.side, out.is_second}, after, start});
    links_[before].next = start;
    links_[after].prev = end;
    here_ = end;
    return true;
  }

  void write(std::vector<Corner>& ring) const {
    std::size_t i = here_;
    do {
      ring.push_back(links_[i].corner);
      i = links_[i].next;
    } while (i != here_);
  }

private:
  [[nodiscard]] const Vec2& at(std::size_t i) const { return links_[i].corner.at; }
  [[nodiscard]] Vec2 between(const Cutter& by, std::size_t from, std::size_t to) const {
    return crossing(at(from), by.inwards(at(from)), at(to), by.inwards(at(to)));
  }

  std::vector<ClipWorkspace::Link>& links_;
  std::size_t here_ = 0;
};

void clip_many(const RingView& a, const RingView& b, ClipWorkspace& w) {
  w.ring.clear();
  Walk walk(a, w.links);
  for (std::size_t i = 0; i < b.count; ++i) {
    const Cutter by(b, i);
    walk.go_out(by, i == 0);
    if (!walk.cut(by)) return;
  }
  walk.write(w.ring);
}

void drop_sides_without_length(std::vector<Corner>& ring) {
  const std::size_t n = ring.size();
  std::size_t kept = 0;
  const Vec2 first = n > 0 ? ring[0].at : Vec2::Zero(); // copied, because it may be overwritten before the last side is tested
  for (std::size_t i = 0; i < n; ++i)
    if (ring[i].at != (i + 1 == n ? first : ring[i + 1].at)) ring[kept++] = ring[i];
  ring.resize(kept);
}

double gap_of_few(const RingView& ring, const RingView& other, double enough) {
  double widest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < ring.count && widest < enough; ++i) {
    const Vec2 e = ring.corners[next(i, ring.count)] - ring.corners[i];
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < other.count; ++k) nearest = std::min(nearest, -cross(e, other.corners[k] - ring.corners[i]));
    widest = std::max(widest, nearest / e.norm());
  }
  return widest;
}

double gap_of_many(const RingView& ring, const RingView& other, double enough) {
  double widest = -std::numeric_limits<double>::infinity();
  std::size_t here = 0;
  for (std::size_t i = 0; i < ring.count && widest < enough; ++i) {
    const Vec2 from = ring.corners[i], e = ring.corners[next(i, ring.count)] - from;
    const auto outwards = [&](std::size_t k) { return -cross(e, other.corners[k] - from); };
    double d = outwards(here);
    for (std::size_t k = 0; i == 0 && k < other.count; ++k)
      if (const double there = outwards(k); there < d) d = there, here = k;
    while (true) {
      const std::size_t one = next(here, other.count), two = next(one, other.count);
      const double d_one = outwards(one), d_two = outwards(two);
      if (!(std::min(d_one, d_two) < d)) break;
      here = d_two < d_one ? two : one;
      d = std::min(d_one, d_two);
    }
    widest = std::max(widest, d / e.norm());
  }
  return widest;
}

} // namespace

void clip(const RingView& a, const RingView& b, ClipWorkspace& w) {
  if (a.count * b.count < k_many_corners) clip_few(a, b, w);
  else clip_many(a, b, w);
  drop_sides_without_length(w.ring);
}

double widest_gap(const RingView& ring, const RingView& other, double enough) {
  return ring.count * other.count < k_many_corners ? gap_of_few(ring, other, enough) : gap_of_many(ring, other, enough);
}

} // namespace steplap
