// What is allowed in a model, but hardly meant: signals that nothing uses, bodies that nothing holds, cores unlike any.
#pragma once

#include "tools/steplap/run.h"

namespace steplap {

[[nodiscard]] std::vector<std::string> warnings_about(const LoadedModel& loaded);
/// What may well be meant, and is worth knowing: a run that begins at rest, but not in equilibrium.
[[nodiscard]] std::vector<std::string> notes_about(const LoadedModel& loaded);

} // namespace steplap
