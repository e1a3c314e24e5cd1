#pragma once

// Three programs that integrate the hand-written transformer, with a common interface.

#include "transformer_minimal.h"

#include <vector>

namespace steplap::peers {

struct Happening {
  double time;
  const char* what;
};

// Results of a run: outputs every 1 ms up to 0.8 s, and the events. Filled if requested.
struct Record {
  std::vector<Outputs> samples;
  std::vector<Happening> happenings;
};

struct RunCounts {
  long steps = 0;
  long rejected = 0;
  long evaluations = 0;
  long events = 0;
};

inline constexpr double k_sample_interval = 1e-3;
inline constexpr int k_samples = 800;

// A program. `tolerance`: error per step, relative to the ranges k_scale of the coordinates.
using TransformerProgram = RunCounts (*)(Condition, double tolerance, Record*);

[[nodiscard]] RunCounts run_transformer_dop853(Condition, double tolerance, Record* record);
[[nodiscard]] RunCounts run_transformer_arkode(Condition, double tolerance, Record* record);
[[nodiscard]] RunCounts run_transformer_cvode(Condition, double tolerance, Record* record);

// Ranges of the coordinates and of their rates in this scene, m, rad, m/s, rad/s.
inline constexpr State k_scale = {1e-3, 2e-4, 2e-3, 2e-4, 2e-3, 3e-3, 0.04, 0.01, 0.05, 0.02, 0.05, 0.08};

} // namespace steplap::peers
