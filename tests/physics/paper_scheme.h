// The paper's transformer by a scheme like the paper's: fixed steps of Runge-Kutta, stick tested once a step, no event located.
//
// The equations are those of docs/explanation/theory.md in seven coordinates. They share no code with the product: parameters alone come
// from a model file. Limbs are held to the active part (their joints carry less than half of what they can).
#pragma once

#include "mbd/model/model.h"

#include <vector>

namespace steplap::testing {

/// How a step decides that a slipping contact sticks. The paper says only that the restriction applies while its force is below the limit.
enum class StickTest {
  at_reversal, ///< the sliding velocity changed sign in the last step; the direction of friction is kept within a step
  below_speed  ///< |velocity| < stick_speed; friction opposes the velocity at each stage
};

struct SchemeSettings {
  StickTest test = StickTest::at_reversal;
  double step = 1e-4;        ///< s
  double stick_speed = 1e-4; ///< m/s, for below_speed
  double end = 0.3;          ///< s
};

/// One entry a step.
struct SchemeHistory {
  std::vector<double> angle;    ///< θ1 − θ5, rad
  std::vector<double> friction; ///< on the active part, N
  std::vector<double> onsets;   ///< times at which a slip begins, s
};

/// Runs a model of models/paper/ by the scheme.
[[nodiscard]] SchemeHistory run_scheme(const Model& model, const SchemeSettings& settings);

} // namespace steplap::testing
