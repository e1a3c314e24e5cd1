// Derivatives of the forces on several bodies with respect to the motions of all of them, from dual numbers.
//
// A law of up to N bodies is evaluated with Dual<6 N>: derivatives with respect to the pose of body j have indices 3 j …, those with
// respect to its velocity 3 N + 3 j …. If a body occurs several times, its contributions add up.
#pragma once

#include "mbd/base/dual.h"
#include "mbd/system/law_group.h"
#include "mbd/system/roles.h"
#include "mbd/system/state_jacobian.h"

#include <array>
#include <vector>

namespace steplap {

/// Appends the derivatives of the force on each body with respect to the motion of each body.
template <int N>
void add_body_blocks(const std::array<int, N>& bodies, const std::array<BodyForceOf<Dual<6 * N>>, N>& forces,
                     std::vector<PairJacobian>& out) {
  for (int row = 0; row < N; ++row)
    for (int column = 0; column < N; ++column) {
      const int x = bodies[static_cast<std::size_t>(row)], y = bodies[static_cast<std::size_t>(column)];
      if (x == k_ground || y == k_ground) continue;
      PairJacobian& j = out.emplace_back();
      j.a = x;
      j.b = x == y ? k_ground : y;
      j.stiffness.setZero();
      j.damping.setZero();
      const BodyForceOf<Dual<6 * N>>& f = forces[static_cast<std::size_t>(row)];
      const Dual<6 * N>* const parts[3] = {&f.fx, &f.fy, &f.m};
      const int at = x == y ? 0 : 3;
      for (int i = 0; i < 3; ++i)
        for (int l = 0; l < 3; ++l) {
          j.stiffness(i, at + l) = parts[i]->d[3 * column + l];
          j.damping(i, at + l) = parts[i]->d[3 * N + 3 * column + l];
        }
    }
}

/// Appends the derivatives of the rate of inner state `inner` with respect to the motion of each body.
template <int N> void add_rate_by_motion(int inner, const std::array<int, N>& bodies, const Dual<6 * N>& rate, StateJacobian& out) {
  for (int j = 0; j < N; ++j)
    if (bodies[static_cast<std::size_t>(j)] != k_ground)
      out.by_motion.push_back({inner, bodies[static_cast<std::size_t>(j)], rate.d.template segment<3>(3 * j).matrix(),
                               rate.d.template segment<3>(3 * N + 3 * j).matrix()});
}

/// Adds a force acting at `lever` from the body's centre of gravity.
template <class S> void add_at(BodyForceOf<S>& sum, const Pair<S>& lever, const Pair<S>& force) {
  sum.fx += force.x;
  sum.fy += force.y;
  sum.m += cross(lever, force);
}

} // namespace steplap
