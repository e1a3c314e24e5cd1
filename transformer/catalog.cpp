#include "transformer/catalog.h"

#include "elements/catalog.h"
#include "transformer/clamp.h"
#include "transformer/core.h"
#include "transformer/recorder.h"
#include "transformer/uncertain.h"

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
