#include "run/catalogue.h"

#include "transformer/catalog.h"
#include "transformer/recorder/recorder_signal.h"

namespace steplap {

const Catalogue& program_catalogue() {
  static const Catalogue catalogue = [] {
    Catalogue c = transformer_catalog();
    c.signals.push_back(&recorder_signal_kind());
    return c;
  }();
  return catalogue;
}

} // namespace steplap
