#include "mbd/math/counter_random.h"

namespace steplap {

PhiloxBlock philox(PhiloxBlock c, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t k_m0 = 0xD2511F53, k_m1 = 0xCD9E8D57;
  constexpr std::uint32_t k_w0 = 0x9E3779B9, k_w1 = 0xBB67AE85;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = k_m0 * c[0], p1 = k_m1 * c[2];
    c = {static_cast<std::uint32_t>(p1 >> 32) ^ c[1] ^ key[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ c[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += k_w0;
    key[1] += k_w1;
  }
  return c;
}

double counter_uniform(std::uint64_t seed, std::uint32_t stream, std::uint64_t sample, std::uint32_t index) {
  const PhiloxBlock block =
      philox({static_cast<std::uint32_t>(sample), static_cast<std::uint32_t>(sample >> 32), index / 2, stream},
             {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  const std::uint64_t bits = index % 2 ? (std::uint64_t{block[2]} << 32 | block[3]) : (std::uint64_t{block[0]} << 32 | block[1]);
  return (static_cast<double>(bits >> 12) + 0.5) * 0x1p-52;
}

} // namespace steplap
