// Links: the ordered pairs of bodies (a, b) between which elements act.
//
// The force of an element between two bodies depends only on the motion of a relative to b. This motion is computed once for all elements
// of a pair, in the axes of b; the elements add their forces in these axes, and the sum is applied once to a and, with opposite sign, to b.
// This saves rotations of axes, and action equals reaction by construction.
#pragma once

#include "mbd/system/motion.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace steplap {

/// A pair of bodies, by index.
struct Link {
  int a = k_ground, b = k_ground;
};

/// Set of all links. Each has a slot (an index) in the arrays of motions and forces: first the slots of the bodies, then those of links
/// between two bodies. A link to the ground uses the slot of its body a, since the motion relative to the ground is that of the body
/// itself.
class LinkTable {
public:
  /// Sets the number of bodies, ground included; slots below it are bodies. To be called before add().
  void start(int body_count) { body_count_ = body_count; }
  /// Returns the slot of the link (a, b), which is added if missing.
  int add(int a, int b);
  /// Returns the slot of a link that was added; throws std::out_of_range otherwise.
  [[nodiscard]] int slot_of(int a, int b) const { return b == k_ground ? a : slot(index_.at(key(a, b))); }
  /// Returns link i of size() links between two bodies, in the order of their slots.
  [[nodiscard]] const Link& operator[](int i) const { return links_[i]; }
  [[nodiscard]] int size() const { return static_cast<int>(links_.size()); }
  /// Returns the slot of link i.
  [[nodiscard]] int slot(int i) const { return body_count_ + i; }
  /// Returns the number of slots of bodies and links.
  [[nodiscard]] int slot_count() const { return body_count_ + size(); }

private:
  static std::uint64_t key(int a, int b) { return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b); }
  int body_count_ = 0;
  std::vector<Link> links_;
  std::unordered_map<std::uint64_t, int> index_;
};

/// Returns the motion of a relative to b: position and velocity relative to the centre of gravity of b, in the rotating axes of b.
template <class S> STEPLAP_INLINE Motion<S> seen_from(const Motion<S>& a, const Motion<S>& b) {
  Motion<S> m;
  const S dx = a.x - b.x, dy = a.y - b.y, dvx = a.vx - b.vx, dvy = a.vy - b.vy;
  m.x = b.c * dx + b.s * dy;
  m.y = b.c * dy - b.s * dx;
  m.theta = a.theta - b.theta;
  m.c = a.c * b.c + a.s * b.s;
  m.s = a.s * b.c - a.c * b.s;
  m.vx = b.c * dvx + b.s * dvy + b.omega * m.y;
  m.vy = b.c * dvy - b.s * dvx - b.omega * m.x;
  m.omega = a.omega - b.omega;
  return m;
}

/// Adds the force on a body that is merged into a cluster (layout.h) to the force on the cluster. `f` acts at the body's centre of gravity,
/// `sum` at that of the cluster.
template <class S>
STEPLAP_INLINE void add_member_force(const BodyForceOf<S>& f, const Motion<S>& member, const Motion<S>& cluster, BodyForceOf<S>& sum) {
  sum.fx += f.fx;
  sum.fy += f.fy;
  sum.m += f.m + (member.x - cluster.x) * f.fy - (member.y - cluster.y) * f.fx;
}

/// Returns the second time derivative of (x, y) of the motion `link` (seen_from) at zero accelerations of both bodies: the sum of the
/// centrifugal term ω² (x, y) and the Coriolis term 2 ω (ẏ, −ẋ), with ω the angular velocity of b.
template <class S> STEPLAP_INLINE Pair<S> frame_acceleration(const Motion<S>& link, const S& omega_b) {
  return {omega_b * (omega_b * link.x + 2.0 * link.vy), omega_b * (omega_b * link.y - 2.0 * link.vx)};
}

/// Adds a link's force to the forces on its bodies. `f` is the force on a at its centre of gravity, in the axes of b; the opposite force
/// acts on b.
template <class S>
STEPLAP_INLINE void add_link_force(const BodyForceOf<S>& f, const Motion<S>& link, const Motion<S>& b, BodyForceOf<S>& on_a,
                                   BodyForceOf<S>& on_b) {
  const S fx = b.c * f.fx - b.s * f.fy, fy = b.s * f.fx + b.c * f.fy;
  on_a.fx += fx;
  on_a.fy += fy;
  on_a.m += f.m;
  on_b.fx -= fx;
  on_b.fy -= fy;
  on_b.m -= f.m + (link.x * f.fy - link.y * f.fx);
}

} // namespace steplap
