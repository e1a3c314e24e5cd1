#include "transformer/catalog.h"

#include "elements/catalog.h"
#include "transformer/core/clamp.h"
#include "transformer/core/core.h"
#include "transformer/core/uncertain.h"
#include "transformer/recorder/recorder.h"

namespace steplap {

const Catalogue& transformer_catalog() {
  static const Catalogue catalogue = [] {
    Catalogue c = element_catalog();
    c.tables.push_back(&core_kind());
    c.tables.push_back(&clamp_kind());
    c.tables.push_back(&recorder_kind());
    c.tables.push_back(&uncertain_kind());
    return c;
  }();
  return catalogue;
}

} // namespace steplap
