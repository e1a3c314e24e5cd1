// What the hard cases should come to: closed forms, or a short computation of its own. Each gives
// the scaled error of a run; the derivation stands beside it in answers.cpp.
#pragma once

#include "tests/hard/hard_cases.h"

namespace steplap::hard {

using Answer = std::function<double(const Finished&)>;

[[nodiscard]] Answer two_springs(double ratio);
[[nodiscard]] double bounce_to_rest(const Finished& run);
[[nodiscard]] double bounce_for_ever(const Finished& run);
[[nodiscard]] double graze_time(const Finished& run);
[[nodiscard]] double graze_depth(const Finished& run);
[[nodiscard]] double belt_cycles(const Finished& run);
/// The channel keeps its first value; no event at all.
[[nodiscard]] Answer rests(const std::string& channel);
[[nodiscard]] double slips_by_a_hair(const Finished& run);
[[nodiscard]] double slow_ramp(const Finished& run);
[[nodiscard]] double two_feet(const Finished& run);
[[nodiscard]] double ten_at_once(const Finished& run);
[[nodiscard]] double rocking(const Finished& run);
[[nodiscard]] Answer dumbbell(double ratio);
[[nodiscard]] Answer two_masses(double ratio);
[[nodiscard]] double parallelogram(const Finished& run);
[[nodiscard]] double redundant_loop(const Finished& run);
[[nodiscard]] double patch_rotation(const Finished& run);
[[nodiscard]] double patch_translation(const Finished& run);
[[nodiscard]] double patch_vanishes(const Finished& run);
[[nodiscard]] double long_oscillation(const Finished& run);
[[nodiscard]] double noisy_record(const Finished& run);
[[nodiscard]] double jumps(const Finished& run);

} // namespace steplap::hard
