#include "mbd/dynamics/kinematics.h"

#include <algorithm>

namespace steplap {

Kinematics::Kinematics(const System& system) : system_(system) {
  motion_.resize(system.bodies.size() + system.links.slot_count()); // an upper bound, reached if every body is a cluster
}

void Kinematics::use(Layout& layout, const State& state) {
  layout_ = &layout;
  state_ = &state;
  time_ = lock_time_ = std::numeric_limits<double>::quiet_NaN();
  is_complete_ = false;
  if (lock_target_.size() < layout.locks.size()) lock_target_.resize(layout.locks.size());
}

void Kinematics::aim_locks(double t) {
  if (t == lock_time_) return;
  lock_time_ = t;
  const RowBase* const bases = state_->bases.data();
  SignalJet* target = lock_target_.data();
  for (const Lock& lock : layout_->locks) {
    *target = row_target(system_.rows[lock.row], bases, t);
    target->value += lock.offset;
    ++target;
  }
}

void Kinematics::place(double t, const double* q, const double* v) {
  const Layout& layout = *layout_;
  time_ = t;
  is_complete_ = false;
  Motion<double>* const motion = motion_.data();
  for (Mechanism& m : layout_->mechanisms) m.place(q + m.first_coordinate, v + m.first_coordinate, motion);
  if (!layout.locks.empty()) aim_locks(t);
  place_all(
      layout, q, v, [this](std::size_t i) -> const SignalJet& { return lock_target_[i]; }, motion);
}

bool Kinematics::is_placed(double t, const double* y) const {
  if (t != time_) return false;
  const double* const v = y + layout_->coordinate_count;
  for (const Mechanism& m : layout_->mechanisms)
    if (!m.is_at(y + m.first_coordinate, v + m.first_coordinate)) return false;
  for (int k = 0; k < layout_->absolute_count; ++k) {
    const Motion<double>& m = motion_[layout_->slots[k]];
    const double* const qk = y + 3 * k;
    const double* const vk = v + 3 * k;
    if (m.x != qk[0] || m.y != qk[1] || m.theta != qk[2] || m.vx != vk[0] || m.vy != vk[1] || m.omega != vk[2]) return false;
  }
  return true;
}

void Kinematics::place_rest() {
  is_complete_ = true;
  place_members(*layout_, layout_->riding_along, motion_.data());
}

} // namespace steplap
