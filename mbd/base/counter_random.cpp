#include "mbd/base/counter_random.h"

#include <Random123/philox.h>

namespace steplap {

PhiloxBlock philox(PhiloxBlock counter, std::array<std::uint32_t, 2> key) {
  const r123::Philox4x32::ctr_type found = r123::Philox4x32()({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
  return {found[0], found[1], found[2], found[3]};
}

double counter_uniform(std::uint64_t seed, std::uint32_t stream, std::uint64_t sample, std::uint32_t index) {
  const PhiloxBlock block = philox({static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32), index / 2, stream},
                                   {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  const std::uint64_t bits = index % 2 ? (std::uint64_t{block[2]} << 32 | block[3]) : (std::uint64_t{block[0]} << 32 | block[1]);
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

} // namespace steplap
