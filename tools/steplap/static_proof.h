// Option `steplap assess --static`: verdict for constant loads, and the largest acceleration in each direction.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

/// Arguments as given on the command line.
struct StaticProofArguments {
  std::vector<std::string> models, overrides;
  std::optional<std::string> preset; ///< value of --static
  std::optional<std::string> plane, directions, largest, output;
  bool is_overwriting = false, is_json = false;
};

/// Runs the proof and prints or writes the results. Precondition: `arguments.preset` is given.
[[nodiscard]] ExitCode prove_statically(const StaticProofArguments& arguments, Console& console);

} // namespace steplap
