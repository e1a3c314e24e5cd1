#include "mbd/system/link.h"

namespace steplap {

int LinkTable::add(int a, int b) {
  if (b == k_ground) return a;
  const auto [place, is_new] = index_.try_emplace(key(a, b), size());
  if (is_new) links_.push_back({a, b});
  return slot(place->second);
}

} // namespace steplap
