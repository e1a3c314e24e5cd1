#include "tools/steplap/colour.h"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iostream>

namespace steplap {

bool is_colour_refused() {
  const char *const refused = std::getenv("NO_COLOR"), *const terminal = std::getenv("TERM");
  return (refused != nullptr && *refused != '\0') || (terminal != nullptr && std::strcmp(terminal, "dumb") == 0);
}

bool takes_colour(const std::ostream& out) { return &out == &std::cout && isatty(STDOUT_FILENO) == 1 && !is_colour_refused(); }

} // namespace steplap
