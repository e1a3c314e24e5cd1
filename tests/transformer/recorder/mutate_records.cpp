// Damages recorders' files by random and reads them: mutate_records COUNT [SEED]. Exit code 1 if one of them is read to something that
// it does not say.
#define DOCTEST_CONFIG_IMPLEMENT
#include "damage.h"

#include <doctest/doctest.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>

using namespace steplap;
using namespace steplap::test;

namespace {

constexpr long k_of_one_file = 50; // damages of each file: to make one takes as long as to read some

struct Tally {
  long tried = 0, read = 0, refused = 0, faults = 0;
  void take(const Damaged& damaged, const char* kind, std::uint32_t file) {
    if (damaged.came == Came::none) return;
    ++tried;
    ++(damaged.came == Came::read ? read : refused);
    if (damaged.fault.empty()) return;
    if (++faults <= 20)
      std::printf("%s, file %u: %s\n----\n%s\n----\n", kind, static_cast<unsigned>(file), damaged.fault.c_str(), damaged.text.c_str());
  }
};

} // namespace

int main(int count, char** arguments) {
  const long wanted = count > 1 ? std::atol(arguments[1]) : 10'000;
  std::mt19937 random(static_cast<std::uint32_t>(count > 2 ? std::atol(arguments[2]) : 1));
  constexpr std::array<const char*, 2> k_kinds = {"bytes", "digit"};
  std::array<Tally, 2> tallies;
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint32_t file = 0; tallies[0].tried + tallies[1].tried < wanted; ++file) {
    const Victim any = random_victim(random, 2 * file, false), plain = random_victim(random, 2 * file + 1, true);
    std::string fault;
    const auto whole = attempt(plain.made.text, plain.options, fault);
    if (!whole) {
      std::printf("file %u is not read: %s\n%s\n", static_cast<unsigned>(file), fault.c_str(), plain.made.text.c_str());
      return 1;
    }
    for (long i = 0; i < k_of_one_file; ++i) {
      tallies[0].take(random_bytes(random, any), k_kinds[0], file);
      if (!plain.made.values.empty()) tallies[1].take(other_digit(random, plain, whole->segments), k_kinds[1], file);
    }
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  long all = 0, faults = 0;
  for (std::size_t k = 0; k < tallies.size(); ++k) {
    std::printf("%s: %ld tried, %ld read, %ld refused, %ld wrong\n", k_kinds[k], tallies[k].tried, tallies[k].read, tallies[k].refused,
                tallies[k].faults);
    all += tallies[k].tried, faults += tallies[k].faults;
  }
  std::printf("%ld damaged files in %.0f s, %.0f a second\n", all, seconds, static_cast<double>(all) / seconds);
  return faults == 0 ? 0 : 1;
}
