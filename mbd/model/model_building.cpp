#include "mbd/model/model_building.h"

namespace steplap {

void add_signal(Model& model, const std::string& kind, std::string name) {
  std::vector<std::string> known;
  for (const SignalKind* k : signal_kinds()) {
    known.push_back(k->name);
    if (k->name != kind) continue;
    model.signals.emplace_back(k, k->create()).definition->name = std::move(name);
    return;
  }
  throw ModelError(Location{}, "there is no kind of signal '" + kind + "'" + did_you_mean(kind, known));
}

} // namespace steplap
