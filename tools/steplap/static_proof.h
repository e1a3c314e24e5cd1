// steplap assess --static: loads that are constant, and the acceleration that is too much in each direction.
#pragma once

#include "tools/steplap/command.h"

namespace steplap {

struct StaticProofArguments {
  std::vector<std::string> models, overrides;
  std::optional<std::string> preset; ///< --static
  std::optional<std::string> plane, directions, largest, output;
  bool is_overwriting = false, is_json = false;
};

/// Precondition: `arguments.preset` is given.
[[nodiscard]] ExitCode prove_statically(const StaticProofArguments& arguments, Console& console);

} // namespace steplap
