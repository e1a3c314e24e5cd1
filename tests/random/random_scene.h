// Scenes made from a seed: a few mechanisms beside each other, some of them coupled, of all kinds of elements.
//
// Physically sane: joints fit, contacts start open or pressed by what rests on them, drives start where the
// bodies are. Times are chosen by the length of the run, so that the fastest vibration has some tens of periods
// and any method can follow it; masses, lengths, stiffnesses and bounds go over decades. The same seed gives the
// same text on every machine.
#pragma once

#include "tests/random/scene.h"

namespace steplap::random {

[[nodiscard]] Scene random_scene(std::uint64_t seed);

/// Blocks with friction, drives and springs on straight rails only: what the independent integration of
/// smooth_friction.h understands.
[[nodiscard]] Scene random_friction_scene(std::uint64_t seed);

} // namespace steplap::random
