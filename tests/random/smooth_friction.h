// Blocks in a row on a straight rail, with springs and dry friction between them and on the rail, integrated here by
// a program of its own that shares nothing with steplap's: no modes, no events, no constraints.
//
// Friction F sign(v) is smoothed, F clamp(v/ε, −1, 1), so that what sticks creeps by less than ε: the motion is that
// of steplap up to an error in proportion to ε (creep ε t, and as much at the ends of slips), which two values of ε
// take away and three estimate. Classical Runge–Kutta steps that resolve the smoothed slope.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace steplap::random {

struct Harmonic {
  double amplitude = 0.0, frequency = 0.0, phase = 0.0; ///< N, Hz, rad
};

struct RailBlock {
  double mass = 1.0, velocity = 0.0;
  double friction = 0.0; ///< on the rail, N; 0: none
  std::vector<Harmonic> load;
  // To the block before; nothing at the first.
  double stiffness = 0.0, damping = 0.0, link_friction = 0.0;
};

struct RailBlocks {
  std::vector<RailBlock> blocks;
  double end = 1.0;

  [[nodiscard]] std::string text() const; ///< the model file
};

[[nodiscard]] RailBlocks random_rail_blocks(std::uint64_t seed);

/// Where the blocks are at `samples` equal times up to the end, without smoothing: extrapolated.
struct SmoothMotion {
  std::vector<std::vector<double>> x;        ///< [sample][block], from the start
  std::vector<std::vector<double>> estimate; ///< largest change by halving ε again, up to the sample
};
[[nodiscard]] SmoothMotion smooth_motion(const RailBlocks& scene, int samples);

} // namespace steplap::random
