#include "tools/steplap/catalogue.h"

#include "elements/catalog.h"

namespace steplap {

const Catalogue& program_catalogue() {
  return element_catalog();
}

} // namespace steplap
