// Damage to recorders' files, and what must not come of it. The test does some thousands, the program mutate_records as many as asked.
#pragma once

#include "record_file.h"

#include <optional>
#include <random>
#include <string>

namespace steplap::test {

/// A file of a random manner, settled so that it is read as it is.
struct Victim {
  Manner manner;
  MadeFile made;
  ReadOptions options;
};
[[nodiscard]] Victim random_victim(std::mt19937& random, std::uint32_t seed, bool is_utf8);

/// What is read of a text; nothing if it is refused. A refusal that does not name the file is none: it is told by `fault`.
[[nodiscard]] std::optional<ReadResult> attempt(const std::string& text, const ReadOptions& options, std::string& fault);
[[nodiscard]] bool is_same(const Segments& a, const Segments& b);

enum class Came { refused, read, none }; ///< none: nothing was changed
struct Damaged {
  std::string text; ///< the damaged file
  Came came = Came::none;
  std::string fault; ///< what must not be; "" if nothing
};

/// One to three bytes or stretches changed, taken out, doubled or cut off: read or refused, nothing else.
[[nodiscard]] Damaged random_bytes(std::mt19937& random, const Victim& victim);
/// A digit of a time or an acceleration changed: what is read changes, or it is refused.
[[nodiscard]] Damaged other_digit(std::mt19937& random, const Victim& victim, const Segments& whole);
/// Cut at a byte: refused, or all that is read is as in the whole file.
[[nodiscard]] Damaged cut_short(const std::string& text, std::size_t length, const ReadOptions& options, const Segments& whole);

} // namespace steplap::test
