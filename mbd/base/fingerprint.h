// 64-bit hash for detecting accidental changes of data. Every step is invertible, so a change within a single word always changes the hash.
// Other changes go unnoticed with probability 2⁻⁶⁴. Not cryptographic: it does not protect against forgery.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

namespace steplap {

/// Hash of all data added so far, in their order.
class Fingerprint {
public:
  void add(std::uint64_t word) {
    hash_ = (hash_ ^ word) * 0x100000001b3; // multiplication by the prime of the FNV hash
    hash_ ^= hash_ >> 32;                   // mixes the high bits into the low ones
    hash_ *= 0x9e3779b97f4a7c15;
  }
  void add(long number) { add(static_cast<std::uint64_t>(number)); }
  /// Adds a number. All NaN give the same hash, and so do +0 and −0.
  void add(double x) { add(x != x ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(x == 0.0 ? 0.0 : x)); }
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    for (std::size_t i = 0; i < text.size(); i += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      const std::string_view part = text.substr(i, sizeof word);
      std::memcpy(&word, part.data(), part.size());
      add(word);
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }
  [[nodiscard]] std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

private:
  std::uint64_t hash_ = 0xcbf29ce484222325;
};

} // namespace steplap
