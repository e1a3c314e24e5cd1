#pragma once

// The three programs that integrate the hand-written transformer, one signature.

#include "transformer_minimal.h"

#include <vector>

namespace steplap::peers {

struct Happening {
  double time;
  const char* what;
};

// Filled if requested: outputs at 1 ms, 2 ms … 0.8 s, and the events.
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

// Tolerance: error per step, as a share of each coordinate's range in this scene.
using TransformerProgram = RunCounts (*)(Condition, double tolerance, Record*);

[[nodiscard]] RunCounts run_transformer_dop853(Condition, double tolerance, Record* record);
[[nodiscard]] RunCounts run_transformer_arkode(Condition, double tolerance, Record* record);
[[nodiscard]] RunCounts run_transformer_cvode(Condition, double tolerance, Record* record);

// Ranges of the coordinates and of their rates, to scale errors with.
inline constexpr State k_scale = {1e-3, 2e-4, 2e-3, 2e-4, 2e-3, 3e-3, 0.04, 0.01, 0.05, 0.02, 0.05, 0.08};

} // namespace steplap::peers
