// Where everything is, the first of the three parts of Dynamics: motions of clusters, links and bodies at one time and
// one set of coordinates.
//
// What a layout fixes (which cluster has which slot, which bodies ride on others, which links there are) is read from
// it; what changes are the motions. place() finds those that forces and rows ask for; bodies that only ride along, as
// parts of a core that hold to each other, wait for complete(), which whoever looks at every body calls.
#pragma once

#include "mbd/dynamics/layout.h"

#include <limits>
#include <vector>

namespace steplap {

/// A body that moves with its cluster k, at a place of it.
template <class S> STEPLAP_INLINE void place_in_cluster(const Placement& place, const Motion<S>& k, Motion<S>& m) {
  const Pair<S> lever = to_ground(k, place.offset);
  m.x = k.x + lever.x;
  m.y = k.y + lever.y;
  m.theta = k.theta + place.angle;
  m.c = k.c * place.c - k.s * place.s;
  m.s = k.s * place.c + k.c * place.s;
  m.vx = k.vx - k.omega * lever.y;
  m.vy = k.vy + k.omega * lever.x;
  m.omega = k.omega;
}

/// A cluster in absolute coordinates: 3 numbers of each.
template <class S> STEPLAP_INLINE void place_cluster(const S* q, const S* v, Motion<S>& m) {
  m.x = q[0];
  m.y = q[1];
  m.vx = v[0];
  m.vy = v[1];
  m.omega = v[2];
  set_angle(m, q[2]);
}

/// A coordinate that a drive prescribes.
template <class S> STEPLAP_INLINE void place_locked(int coordinate, const S& value, const S& rate, Motion<S>& m) {
  if (coordinate == 2) set_angle(m, value);
  else (coordinate == 0 ? m.x : m.y) = value;
  (coordinate == 0 ? m.vx : coordinate == 1 ? m.vy : m.omega) = rate;
}

class Kinematics {
public:
  explicit Kinematics(const System& system);
  Kinematics(const Kinematics&) = delete; // what it places is pointed into
  Kinematics& operator=(const Kinematics&) = delete;

  /// Both must outlive the use of this object or be set anew. What was placed before is forgotten.
  void use(Layout& layout, const State& state);

  /// At time t, coordinates q and rates v of the layout.
  void place(double t, const double* q, const double* v);
  /// Are those the ones that were placed last? y: q, then v.
  [[nodiscard]] bool is_placed(double t, const double* y) const;
  /// Bodies that place() has left out.
  void complete() {
    if (!is_complete_) place_rest();
  }

  /// Targets of the driven coordinates at t: several evaluations of a step are at the same time.
  void aim_locks(double t);
  [[nodiscard]] const SignalJet& lock_target(std::size_t lock) const { return lock_target_[lock]; }

  /// Bodies, links (of a, seen from b), clusters of several bodies; the same memory for the life of this object.
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }

private:
  void place_member(int body);
  void place_lock(std::size_t lock);
  void place_rest();

  const System& system_;
  Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  std::vector<Motion<double>> motion_;
  std::vector<SignalJet> lock_target_; ///< per lock, at lock_time_
  double lock_time_ = std::numeric_limits<double>::quiet_NaN();
  double time_ = std::numeric_limits<double>::quiet_NaN(); ///< of motion_
  bool is_complete_ = false;
};

} // namespace steplap
