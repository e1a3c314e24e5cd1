// Impact of inextensible ropes that become taut, and of one-way clutches that are turned against their lock. Velocities jump, positions do
// not.
//
// Impulses Λ ≥ 0 act along all ropes at their full length and on all clutches. With u the rates of lengthening (or of turning against the
// lock) before the impact and u⁺ those after it:
//   u⁺ = u − A Λ ≤ 0,  Λᵀu⁺ = 0,  A = J P Jᵀ,
// where P is the inverse mass matrix under the constraints of joints and drives. There is no restitution: a rope with Λ > 0 does not
// lengthen afterwards, a clutch with Λ > 0 is locked.
//
// Elements with a bounded force have no impulse: springs, contacts, clutches with a bounded torque, and friction, whose bound is a multiple
// of a finite force (a sticking element may slide after the impact). The energy ½ Δvᵀ M Δv = ½ Λᵀu is dissipated. With moving drives, the
// rest of the change of energy is their work.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/one_sided_row.h"

#include <string>
#include <string_view>

namespace steplap {

/// Sets the phases of ropes at the start of a run: taut if they are at their length and do not shorten, otherwise slack. Returns true if a
/// taut rope lengthens, which requires apply_impact(). Throws ElementFailure if the ends of a rope are further apart than its length.
[[nodiscard]] bool set_ropes(const System& system, State& state);

/// Computes the impact of ropes and clutches at `state`. Changes velocities, phases of ropes and of clutches that lock, impacts, dissipated
/// energy and work. Other phases stay unchanged; the caller decides them from the new velocities. Throws ElementFailure if the impulses
/// cannot be determined or drives turn a clutch against its lock.
void apply_impact(const System& system, Dynamics& dynamics, State& state);

/// Returns true if the bodies of some clutch turn against its lock with a rate above rounding. This requires apply_impact().
[[nodiscard]] bool turns_against_lock(const System& system, const State& state);

/// Computes the impact of joints and drives that become active: their rates jump to the prescribed ones with the least change of velocities
/// in the metric of kinetic energy, Δv = −M⁻¹Jᵀ(J M⁻¹ Jᵀ)⁻¹(Jv − target). Friction, ropes and clutches have no impulse; call apply_impact()
/// afterwards. The energy ½ Δvᵀ M Δv is dissipated; the rest of the change of energy is work of moving drives.
void close_rows(const System& system, Dynamics& dynamics, State& state);

/// Impact of the rope or clutch `friction` since the impacts were `before`: whether there was one, and its impulse and energy loss as text
/// (empty if none).
[[nodiscard]] bool had_impact(const System& system, std::size_t friction, const std::vector<Impact>& before, const State& state);
[[nodiscard]] std::string impact_text(const System& system, std::size_t friction, const std::vector<Impact>& before, const State& state);

} // namespace steplap
