// Where a command writes: results to `out`, everything about the run to `err`.
#pragma once

#include <iosfwd>

namespace steplap {

enum class Verbosity { quiet, normal, verbose };

struct Console {
  std::ostream& out;
  std::ostream& err;
  bool is_terminal = false; ///< `err` is a terminal: progress may be shown
  Verbosity verbosity = Verbosity::normal;
};

} // namespace steplap
