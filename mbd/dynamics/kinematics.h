// Motions of clusters, links and bodies at one time and for one set of coordinates; the first of the three parts of Dynamics.
//
// place() computes only the motions that forces and rows need. The motions of other bodies in clusters, for example parts of a core that
// stick together, are computed by complete(), which must be called before the motions of all bodies are read.
#pragma once

#include "mbd/dynamics/equations.h"

#include <limits>
#include <span>
#include <vector>

namespace steplap {

/// Computes motions from the coordinates of a layout. Does not allocate after construction.
class Kinematics {
public:
  /// `system` must outlive this object. use() must be called before any other function.
  explicit Kinematics(const System& system);
  Kinematics(const Kinematics&) = delete; // others keep pointers into its arrays
  Kinematics& operator=(const Kinematics&) = delete;

  /// Sets layout and state, which must exist until the next call of use(). The present motions become invalid.
  void use(Layout& layout, const State& state);

  /// Computes motions at time t from the layout's coordinates q and rates v.
  void place(double t, const double* q, const double* v);
  /// Returns true if the present motions are those at t and y, which contains q, then v.
  [[nodiscard]] bool is_placed(double t, const double* y) const;
  /// Computes the motions that place() has omitted.
  void complete() {
    if (!is_complete_) place_rest();
  }

  /// Computes the prescribed values of locked coordinates at t. Costs nothing if t is that of the last call.
  void aim_locks(double t);
  [[nodiscard]] const SignalJet& lock_target(std::size_t lock) const { return lock_target_[lock]; }
  [[nodiscard]] std::span<const SignalJet> lock_targets() const { return {lock_target_.data(), layout_->locks.size()}; }

  /// Returns the motions of bodies, links (a relative to b) and clusters of several bodies, by slot. The address never changes.
  [[nodiscard]] const std::vector<Motion<double>>& motion() const { return motion_; }

private:
  void place_rest();

  const System& system_;
  Layout* layout_ = nullptr;
  const State* state_ = nullptr;
  std::vector<Motion<double>> motion_;
  std::vector<SignalJet> lock_target_; ///< per lock, at lock_time_
  double lock_time_ = std::numeric_limits<double>::quiet_NaN();
  double time_ = std::numeric_limits<double>::quiet_NaN(); ///< time of the motions in motion_
  bool is_complete_ = false;
};

} // namespace steplap
