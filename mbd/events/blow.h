// The blow when inextensible ropes reach their length, or one-way clutches would turn against their lock: velocities jump, places do
// not.
//
// Impulses Λ ≥ 0 along the ropes that are taut or at their length, and of all clutches, with u their rates of lengthening, or of
// turning against the lock, before:
//   u⁺ = u − A Λ ≤ 0,  Λᵀu⁺ = 0,  A = J P Jᵀ, P the inverse mass under what holds (joints, drives)
// without restitution: a rope that bears a part of the blow lengthens no more, a clutch that does is locked. What gives forces only
// bears none of it: springs, contacts, and friction, whose bound is a multiple of a force (what sticks may slide behind the blow),
// and a clutch whose couple has a bound. What is lost, ½ Δvᵀ M Δv = ½ Λᵀu, is dissipated; what drives that move give beside that is
// their work.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/system/one_sided_row.h"

#include <string>
#include <string_view>

namespace steplap {

/// The detail of an action's event ends with these words, behind the energy, if joints that it closed took a blow.
inline constexpr std::string_view k_with_a_blow = " J lost in a blow";

/// Ropes at the pose of `state`, as a run begins: taut at their length unless they shorten, else slack. True if some would
/// lengthen beyond it, which takes a blow. Throws where one is too short for its pose.
[[nodiscard]] bool set_ropes(const System& system, State& state);

/// Changes velocities, the ropes' phases, memories, dissipated energy and work; phases of friction are left as they were, those of
/// clutches too: whether they are locked is seen by their rates.
void take_blow(const System& system, Dynamics& dynamics, State& state);

/// Do the bodies of some clutch turn against its lock, by more than counts as rest? That takes a blow.
[[nodiscard]] bool turns_against_lock(const System& system, const State& state);

/// The blow when joints and drives close that did not act before: their rows' rates jump to what they hold, as the least change of
/// velocities in the measure of the kinetic energy does it, Δv = −M⁻¹Jᵀ(J M⁻¹ Jᵀ)⁻¹(Jv − target). Friction bears none of it, nor do
/// ropes and clutches: take_blow() comes after it. ½ Δvᵀ M Δv is dissipated; what moving drives give beside that is their work.
void close_rows(const System& system, Dynamics& dynamics, State& state);

/// Of the last blow that a rope or a clutch took; `before`: the memory as it was then.
[[nodiscard]] bool was_struck(const System& system, std::size_t friction, const std::vector<double>& before, const State& state);
[[nodiscard]] std::string blow_text(const System& system, std::size_t friction, const std::vector<double>& before, const State& state);

} // namespace steplap
