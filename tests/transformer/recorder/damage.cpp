#include "damage.h"

#include <algorithm>

namespace steplap::test {

namespace {

std::size_t below(std::mt19937& random, std::size_t n) { return static_cast<std::size_t>(random()) % n; }
bool same(const Sample& p, const Sample& q) { return p.t == q.t && p.a == q.a; }

} // namespace

Victim random_victim(std::mt19937& random, std::uint32_t seed, bool is_utf8) {
  Victim victim;
  victim.manner = random_manner(random);
  if (is_utf8) victim.manner.encoding = Encoding::utf8; // digits are looked up in the text
  victim.made = make_file(victim.manner, seed);
  for (const Open& open : victim.made.open) open.settle(victim.options);
  return victim;
}

std::optional<ReadResult> attempt(const std::string& text, const ReadOptions& options, std::string& fault) {
  try {
    return read_text(text, options);
  } catch (const RecordError& error) {
    if (!std::string(error.what()).starts_with("record.csv")) fault = std::string("a refusal without a place: ") + error.what();
  } catch (const std::exception& error) {
    fault = std::string("no refusal, but: ") + error.what();
  }
  return std::nullopt;
}

bool is_same(const Segments& a, const Segments& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](const auto& p, const auto& q) { return std::equal(p.begin(), p.end(), q.begin(), q.end(), same); });
}

Damaged random_bytes(std::mt19937& random, const Victim& victim) {
  Damaged damaged{victim.made.text, Came::none, ""};
  std::string& text = damaged.text;
  for (std::size_t changes = 1 + below(random, 3); changes > 0 && !text.empty(); --changes) {
    const std::size_t at = below(random, text.size()), length = 1 + below(random, 12);
    switch (below(random, 5)) {
    case 0: text[at] = static_cast<char>(below(random, 256)); break;
    case 1: text[at] = "0123456789.,;-+eE \t\r\n\"#*:/"[below(random, 27)]; break;
    case 2: text.erase(at, length); break;
    case 3: text.insert(at, text.substr(below(random, text.size()), length)); break;
    default: text.resize(at + 1);
    }
  }
  damaged.came = attempt(text, victim.options, damaged.fault) ? Came::read : Came::refused;
  return damaged;
}

Damaged other_digit(std::mt19937& random, const Victim& victim, const Segments& whole) {
  Damaged damaged{victim.made.text, Came::none, ""};
  const auto [begin, length] = victim.made.values[below(random, victim.made.values.size())];
  const std::size_t at = begin + below(random, std::max<std::size_t>(length, 1));
  std::string& text = damaged.text;
  if (length == 0 || text[at] < '0' || text[at] > '9') return damaged;
  text[at] = static_cast<char>('0' + (text[at] - '0' + 1 + static_cast<int>(below(random, 9))) % 10);
  const auto result = attempt(text, victim.options, damaged.fault);
  damaged.came = result ? Came::read : Came::refused;
  if (result && is_same(result->segments, whole))
    damaged.fault = "'" + victim.made.text.substr(begin, length) + "' and '" + text.substr(begin, length) + "' are read alike (" +
                    text_of(victim.manner) + ")";
  return damaged;
}

Damaged cut_short(const std::string& text, std::size_t length, const ReadOptions& options, const Segments& whole) {
  Damaged damaged{text.substr(0, length), Came::refused, ""};
  const auto result = attempt(damaged.text, options, damaged.fault);
  if (!result) return damaged;
  damaged.came = Came::read;
  for (std::size_t s = 0; s < result->segments.size() && damaged.fault.empty(); ++s) {
    const std::vector<Sample>& read = result->segments[s];
    if (s >= whole.size() || read.size() > whole[s].size()) damaged.fault = "more samples than in the whole file";
    else if (!std::equal(read.begin(), read.end(), whole[s].begin(), same)) damaged.fault = "a sample that is not in the whole file";
  }
  return damaged;
}

} // namespace steplap::test
