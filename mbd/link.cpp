#include "mbd/link.h"

namespace steplap {

int LinkTable::add(int a, int b) {
  const auto [place, is_new] = index_.try_emplace(key(a, b), size());
  if (is_new) links_.push_back({a, b});
  return place->second;
}

} // namespace steplap
