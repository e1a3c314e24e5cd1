// Where everything is, the first of the three parts of Dynamics: motions of clusters, links and bodies at one time and
// one set of coordinates.
//
// What a layout fixes (which cluster has which slot, which bodies ride on others, which links there are) is read from
// it; what changes are the motions. place() finds those that forces and rows ask for; bodies that only ride along, as
// parts of a core that hold to each other, wait for complete(), which whoever looks at every body calls.
#pragma once

#include "mbd/dynamics/equations.h"

#include <limits>
#include <span>
#include <vector>

namespace steplap {

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
  [[nodiscard]] std::span<const SignalJet> lock_targets() const { return {lock_target_.data(), layout_->locks.size()}; }

  /// Bodies, links (of a, seen from b), clusters of several bodies; the same memory for the life of this object.
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }

private:
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
