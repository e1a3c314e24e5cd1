// Scenes brought to rest from the poses in which they are written.
#pragma once

#include "mbd/rest/assembly.h"
#include "mbd/rest/equilibrium.h"
#include "tests/physics/model_text.h"
#include "tests/physics/scene.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numbers>
#include <string>

namespace steplap::testing {

inline constexpr double k_g = 9.81, k_pi = std::numbers::pi;
inline const std::string k_head = "[simulation]\nstep = 1e-3\n";

inline std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}
inline std::string point(double x, double y) { return "[" + number(x) + ", " + number(y) + "]"; }

struct Found {
  std::unique_ptr<System> system;
  Equilibrium rest;

  [[nodiscard]] double q(int body, int c) const { return rest.state.q[3 * static_cast<std::size_t>(body) + static_cast<std::size_t>(c)]; }
};

inline Found settle(const Model& model, RestAlgebra algebra = RestAlgebra::by_size) {
  Found found{compile(model), {}};
  State start = assembled_start(*found.system, assemble(model, *found.system));
  std::fill(start.v.begin(), start.v.end(), 0.0);
  found.rest = find_equilibrium(*found.system, start, algebra);
  return found;
}
inline Found settle(const std::string& text) { return settle(scene(k_head + text)); }
inline std::string reason(const std::string& text) {
  try {
    (void)settle(text);
  } catch (const NumericalFailure& failure) {
    return failure.what();
  }
  return "";
}

} // namespace steplap::testing
