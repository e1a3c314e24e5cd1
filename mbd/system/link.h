// Links: the ordered pairs of bodies (a, b) that elements act between.
//
// Whatever joins two bodies depends only on how b sees a. So the motion of a in b's frame is found once
// for all elements of the pair, they add their forces there, and the sum goes back to the two bodies
// once: fewer turns of axes, and action = reaction without a further thought.
#pragma once

#include "mbd/system/motion.h"

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace steplap {

struct Link {
  int a = k_ground, b = k_ground;
};

/// Every link has a *slot* in the arrays of motions and forces, behind those of the bodies: what the ground
/// sees is the body's own motion, so there the slot is the body's.
class LinkTable {
public:
  /// Slots below `body_count` are bodies.
  void start(int body_count) { body_count_ = body_count; }
  /// Slot of the link (a, b), which is added if it is not there.
  int add(int a, int b);
  [[nodiscard]] int slot_of(int a, int b) const { return b == k_ground ? a : slot(index_.at(key(a, b))); }
  /// Links between two bodies, in the order of their slots.
  [[nodiscard]] const Link& operator[](int i) const { return links_[i]; }
  [[nodiscard]] int size() const { return static_cast<int>(links_.size()); }
  [[nodiscard]] int slot(int i) const { return body_count_ + i; }
  [[nodiscard]] int slot_count() const { return body_count_ + size(); }

private:
  static std::uint64_t key(int a, int b) { return static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b); }
  int body_count_ = 0;
  std::vector<Link> links_;
  std::unordered_map<std::uint64_t, int> index_;
};

/// Motion of a in b's axes, about b's centre of gravity.
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

/// Adds the force on a member of a cluster, given at its centre, to the cluster's.
template <class S>
STEPLAP_INLINE void add_member_force(const BodyForceOf<S>& f, const Motion<S>& member, const Motion<S>& cluster, BodyForceOf<S>& sum) {
  sum.fx += f.fx;
  sum.fy += f.fy;
  sum.m += f.m + (member.x - cluster.x) * f.fy - (member.y - cluster.y) * f.fx;
}

/// Second rate of (x, y) of that motion at zero accelerations of both bodies: centrifugal and Coriolis.
template <class S> STEPLAP_INLINE Pair<S> frame_acceleration(const Motion<S>& link, const S& omega_b) {
  return {omega_b * (omega_b * link.x + 2.0 * link.vy), omega_b * (omega_b * link.y - 2.0 * link.vx)};
}

/// Adds the force on a, given at a's centre in b's axes, to both bodies.
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
