// Output streams of a command: `out` for results, `err` for messages about the run.
#pragma once

#include <iosfwd>

namespace steplap {

enum class Verbosity { quiet, normal, verbose };

/// Streams and verbosity of a command.
struct Console {
  std::ostream& out;
  std::ostream& err;
  bool is_terminal = false; ///< true if `err` is a terminal, on which progress may be shown
  Verbosity verbosity = Verbosity::normal;
};

} // namespace steplap
