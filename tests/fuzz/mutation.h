// Model files changed at random where such a file has its joints: numbers to extremes, keys and values for others', tables twice, left out,
// moved, or taken from another file. The same seed and number give the same text on every machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace steplap::fuzz {

/// Case `number` of the seed: `text` with one to five changes; tables, keys and words that are put in come from it or from `other`.
[[nodiscard]] std::string mutated(const std::string& text, const std::string& other, std::uint64_t seed, std::uint64_t number);

/// Which of `count` things case `number` takes; `which` tells two draws apart.
[[nodiscard]] std::size_t drawn(std::size_t count, std::uint64_t seed, std::uint64_t number, std::uint64_t which);

} // namespace steplap::fuzz
