// One scene in absolute and in joint coordinates: two ways to the same motion.
#pragma once

#include "mbd/dynamics/dynamics.h"
#include "mbd/rest/assembly.h"
#include "tests/physics/scene.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace steplap::testing {

inline State start_of(const Model& model, const System& system) { return assembled_start(system, assemble(model, system)); }

inline int count_coordinates(const System& system, const State& state, Coordinates coordinates = Coordinates::joint) {
  Dynamics dynamics(system);
  dynamics.use_coordinates(coordinates);
  dynamics.set_state(state);
  return dynamics.coordinate_count();
}

inline double largest(const std::vector<double>& values) {
  double size = 0.0;
  for (const double v : values) size = std::max(size, std::abs(v));
  return size;
}

inline RunResult run_in(const Model& model, const System& system, Coordinates coordinates, double tolerance, double end) {
  SimulationOptions options = options_of(model);
  options.integrator = "dop853";
  options.settings.tolerance = tolerance;
  options.settings.step = 0.0;
  options.end = end;
  options.output_step = end / 20.0;
  options.channels.clear();
  options.coordinates = coordinates;
  return simulate(system, start_of(model, system), options);
}

// Of the larger of a channel's largest value and a thousandth of its unit.
inline double difference(const System& system, const RunResult& a, const RunResult& b, std::string& worst_channel) {
  REQUIRE(a.trajectory->size() == b.trajectory->size());
  double worst = 0.0;
  for (const Channel& channel : system.channels) {
    const std::vector<double> x = a.trajectory->series(channel.name), y = b.trajectory->series(channel.name);
    const double size = std::max(largest(x), 1e-3);
    for (std::size_t i = 0; i < x.size(); ++i)
      if (const double d = std::abs(x[i] - y[i]) / size; d > worst) {
        worst = d;
        worst_channel = channel.name;
      }
  }
  return worst;
}

} // namespace steplap::testing
