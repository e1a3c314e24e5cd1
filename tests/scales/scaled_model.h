// A model whose lengths, times and masses are so many times as large: the same model in other units. Whatever it does, it
// does alike, with each number so many times as large as the powers of its unit say.
//
// What scales follows from the units of the tables of fields; a signal has that of the field that takes it. Of powers of two
// every product is exact, and of powers of four every square root of one.
#pragma once

#include "mbd/simulation/simulation.h"

#include <string>

namespace steplap::testing {

struct Scaling {
  double length = 1.0, time = 1.0, mass = 1.0;

  /// Of a quantity in `unit`. Throws std::invalid_argument for a unit that is not known.
  [[nodiscard]] double factor(const std::string& unit) const;
  [[nodiscard]] std::string text() const;
};

/// Of a completed model. Limits of criteria in which check_presentation() has put values are scaled by the units of `system`'s
/// channels, `system` being compiled from `model`. Formulas stay as they are.
[[nodiscard]] Model scaled(const Model& model, const System& system, const Scaling& by);

} // namespace steplap::testing
