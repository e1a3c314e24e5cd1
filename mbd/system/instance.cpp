#include "mbd/system/instance.h"

#include "mbd/model/completion.h"
#include "mbd/model/model_path.h"

namespace steplap {

std::unique_ptr<System> instantiate(const Model& given, const ModelValues& values) {
  Model model = given;
  for (const auto& [path, value] : values) set_value(model, path, value);
  return compile(completed(model));
}

} // namespace steplap
