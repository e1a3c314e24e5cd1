#include "run/catalogue.h"

#include "transformer/catalog.h"

namespace steplap {

const Catalogue& program_catalogue() {
  return transformer_catalog();
}

} // namespace steplap
