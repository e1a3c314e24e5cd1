// How the equations of motion are evaluated. Results do not depend on these choices, except for rounding by the coordinates.
#pragma once

#include <cstdint>

namespace steplap {

/// Type of coordinates for islands that allow both; `automatic`: joint coordinates where they are cheaper.
enum class Coordinates : unsigned char { automatic, joint, absolute };

/// Use of machine code for stages. The results are bit-identical in all cases.
enum class StageCode : std::uint8_t {
  never,
  when_it_pays, ///< after a set of modes has persisted for so long that code would have repaid its compilation
  at_once,      ///< from the second stage on
};

} // namespace steplap
