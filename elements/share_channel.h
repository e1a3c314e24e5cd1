// Channel "share" of one-dimensional dry friction: friction force relative to its bound at the same time.
#pragma once

#include "mbd/system/slight_force.h"

#include <algorithm>
#include <cmath>

namespace steplap {

/// Adds "share" to the element that is being compiled. Precondition: `friction` is the next friction element to be added to the builder.
///
///   sticks  |λ| / bound, with the static bound of the same evaluation, at most 1
///   slips   1, or 0 if the bound is zero
///   free    0
///
/// A bound below slight_force() is replaced by it: a contact with a smaller normal force carries nothing worth reporting, and its λ is
/// rounding.
inline void add_share_channel(SystemBuilder& builder, const FrictionElement& friction) {
  const double slight = slight_force(builder.compiled(), *friction.rows({}));
  const auto share = [self = &friction, f = builder.next_friction(), slot = builder.next_friction_row(), slight](const Snapshot& s) {
    const FrictionState& state = s.evaluation->friction[f];
    if (state.phase != FrictionPhase::stick && state.phase != FrictionPhase::slip) return 0.0;
    const double unit_rate = 1.0, bound = self->support(*s.evaluation, state, &unit_rate);
    if (state.phase == FrictionPhase::slip) return bound > 0.0 ? 1.0 : 0.0;
    const double force = std::abs(s.friction_force[slot]);
    return force > 0.0 ? std::min(1.0, force / std::max(bound, slight)) : 0.0; // λ may exceed its bound by rounding
  };
  // Bounds of the channel for the search for extremes: at least 0, and at most 1, which is reached once the element has slipped. They save
  // several evaluations at the kink of each reversal of λ.
  Channel& channel = builder.add_channel(
      "share", "", {"force over what holds at the same instant; 1 where it slips, 0 without load", "never negative"}, share);
  channel.role = ChannelRole::friction_use;
  channel.bounds = [share, f = builder.next_friction()](const Snapshot& s) {
    return ValueBounds{0.0, s.evaluation->friction[f].has_slipped ? 1.0 : share(s)};
  };
}

} // namespace steplap
