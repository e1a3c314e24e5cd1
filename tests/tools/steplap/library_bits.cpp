// Prints a digest of the C library's functions: it tells whether two ways of starting a program give other routines.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <initializer_list>

int main() {
  std::uint64_t digest = 0;
  for (int i = 1; i < 20000; ++i) {
    const double x = 1.7321e-3 * i;
    for (const double value : {std::sin(x), std::cos(x), std::exp(-x), std::log(x), std::pow(x, 1.5), std::atan2(x, 1.3)})
      digest = digest * 6364136223846793005u + std::bit_cast<std::uint64_t>(value);
  }
  std::printf("%016llx\n", static_cast<unsigned long long>(digest));
}
