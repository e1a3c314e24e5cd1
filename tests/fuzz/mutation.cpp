#include "tests/fuzz/mutation.h"

#include "tests/random/random_number.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace steplap::fuzz {

namespace {

using random::RandomNumber;
using Lines = std::vector<std::string>;

constexpr std::size_t k_longest = 200'000; // bytes: tables that are doubled again and again would fill the memory

std::uint64_t seed_of(std::uint64_t seed, std::uint64_t number, std::uint64_t which) {
  return RandomNumber(RandomNumber(RandomNumber(seed).bits() ^ number).bits() ^ which).bits();
}

/// A table with its header, or what stands before the first one.
using Block = Lines;

std::vector<Block> blocks_of(const std::string& text) {
  std::vector<Block> blocks(1);
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.front() == '[') blocks.emplace_back();
    blocks.back().push_back(line);
  }
  return blocks;
}

std::string text_of(const std::vector<Block>& blocks) {
  std::string text;
  for (const Block& block : blocks)
    for (const std::string& line : block) text += line + "\n";
  return text;
}

/// Where numbers or quoted words stand in a text: begin and length.
using Spans = std::vector<std::pair<std::size_t, std::size_t>>;

// Numbers that say something: not in names ("limb 2") and not in comments.
Spans numbers_in(const std::string& text) {
  Spans found;
  const auto is_part = [&](std::size_t i) { return std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_'; };
  bool is_quoted = false, is_comment = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') is_quoted = is_comment = false;
    if (text[i] == '"') is_quoted = !is_quoted;
    if (text[i] == '#' && !is_quoted) is_comment = true;
    if (is_comment || (is_quoted && i > 0 && text[i - 1] != '"' && text[i - 1] != '-')) continue;
    if (std::isdigit(static_cast<unsigned char>(text[i])) == 0 || (i > 0 && is_part(i - 1))) continue;
    const std::size_t begin = i > 0 && (text[i - 1] == '-' || text[i - 1] == '+') ? i - 1 : i;
    char* end = nullptr;
    (void)std::strtod(text.c_str() + begin, &end);
    const std::size_t length = static_cast<std::size_t>(end - text.c_str()) - begin;
    if (length == 0) continue;
    found.emplace_back(begin, length);
    i = begin + length;
  }
  return found;
}

Spans words_in(const std::string& text) {
  Spans found;
  for (std::size_t open = text.find('"'); open != std::string::npos; open = text.find('"', open)) {
    const std::size_t close = text.find_first_of("\"\n", open + 1);
    if (close == std::string::npos) break;
    if (text[close] == '"') found.emplace_back(open, close + 1 - open);
    open = close + 1;
  }
  return found;
}

class Mutator {
public:
  Mutator(const std::string& text, const std::string& other, std::uint64_t seed) : random_(seed), text_(text), other_(other) {}

  std::string run() {
    // Most models bear one or two changes of numbers, and hardly any a handful of all kinds.
    const int changes = random_.chance(0.8) ? 1 + random_.below(2) : 1 + random_.below(5);
    is_gentle_ = random_.chance(0.7);
    for (int i = 0; i < changes && text_.size() < k_longest; ++i) change();
    return text_;
  }

private:
  void change() {
    if (is_gentle_ && random_.chance(0.9)) return change_number();
    switch (random_.below(12)) {
    case 0:
    case 1:
    case 2:
    case 3: return change_number();
    case 4: return change_word();
    case 5: return change_lines();
    case 6: return move_key();
    case 7: return swap_values();
    case 8: return change_byte();
    default: return change_tables();
    }
  }

  template <class T> std::size_t any(const std::vector<T>& of) {
    return static_cast<std::size_t>(random_.below(static_cast<int>(of.size())));
  }

  void change_number() {
    static const std::vector<std::string> extremes = {"0",
                                                      "-0.0",
                                                      "1",
                                                      "-1",
                                                      "2",
                                                      "1e-300",
                                                      "-1e-300",
                                                      "1e-20",
                                                      "1e-12",
                                                      "1e-9",
                                                      "1e-6",
                                                      "1e6",
                                                      "1e9",
                                                      "1e12",
                                                      "1e20",
                                                      "1e300",
                                                      "-1e300",
                                                      "1e-320",
                                                      "nan",
                                                      "inf",
                                                      "-inf",
                                                      "9223372036854775807",
                                                      "2147483648",
                                                      "0.1",
                                                      "3.141592653589793"};
    const Spans numbers = numbers_in(text_);
    if (numbers.empty()) return;
    const auto [begin, length] = numbers[any(numbers)];
    const double value = std::strtod(text_.c_str() + begin, nullptr);
    std::string now;
    switch (random_.below(8)) {
    case 0: now = extremes[any(extremes)]; break;
    case 1:
    case 2: now = random::number(value * random_.decades(-12.0, 12.0)); break;
    case 3: now = random::number(value * random_.decades(-2.0, 2.0)); break;
    case 4:
    case 5: now = random::number(random_.chance(0.5) ? -value : value * (1.0 + 1e-6 * random_.either(0.1, 1.0))); break;
    default: {
      const auto [from, size] = numbers[any(numbers)];
      now = text_.substr(from, size);
    }
    }
    text_.replace(begin, length, now);
  }

  // A name, unit or choice for another one.
  void change_word() {
    const Spans words = words_in(text_);
    const std::string& source = random_.chance(0.7) ? text_ : other_;
    const Spans others = words_in(source);
    if (words.empty() || others.empty()) return;
    const auto [from, size] = others[any(others)];
    const std::string now = source.substr(from, size);
    const auto [begin, length] = words[any(words)];
    text_.replace(begin, length, now);
  }

  void change_lines() {
    std::vector<Block> blocks = blocks_of(text_);
    Block& block = blocks[any(blocks)];
    if (block.empty()) return;
    const auto at = static_cast<std::ptrdiff_t>(any(block));
    if (random_.chance(0.6)) block.erase(block.begin() + at);
    else block.insert(block.begin() + at, block[any(block)]);
    text_ = text_of(blocks);
  }

  // A line of any table in another one.
  void move_key() {
    std::vector<Block> blocks = blocks_of(text_);
    const std::vector<Block> sources = random_.chance(0.5) ? blocks : blocks_of(other_);
    const Block& source = sources[any(sources)];
    if (source.empty()) return;
    const std::string line = source[any(source)];
    blocks[any(blocks)].push_back(line);
    text_ = text_of(blocks);
  }

  // Two keys exchange their values.
  void swap_values() {
    std::vector<Block> blocks = blocks_of(text_);
    Block &a = blocks[any(blocks)], &b = random_.chance(0.5) ? a : blocks[any(blocks)];
    if (a.empty() || b.empty()) return;
    std::string &one = a[any(a)], &two = b[any(b)];
    const std::size_t first = one.find('='), second = two.find('=');
    if (&one == &two || first == std::string::npos || second == std::string::npos) return;
    const std::string value = one.substr(first);
    one = one.substr(0, first) + two.substr(second);
    two = two.substr(0, second) + value;
    text_ = text_of(blocks);
  }

  void change_tables() {
    std::vector<Block> blocks = blocks_of(text_);
    const std::size_t at = any(blocks);
    switch (random_.below(4)) {
    case 0: blocks.erase(blocks.begin() + static_cast<std::ptrdiff_t>(at)); break;
    case 1: {
      Block twice = blocks[at];
      if (random_.chance(0.7)) // of another name
        for (std::string& line : twice)
          if (line.rfind("name", 0) == 0 && line.find('"') != std::string::npos) line.insert(line.find('"') + 1, "again ");
      blocks.insert(blocks.begin() + static_cast<std::ptrdiff_t>(any(blocks)), twice);
      break;
    }
    case 2: std::swap(blocks[at], blocks[any(blocks)]); break;
    default: {
      const std::vector<Block> sources = blocks_of(other_);
      blocks.push_back(sources[any(sources)]);
    }
    }
    text_ = text_of(blocks);
  }

  void change_byte() {
    if (text_.empty()) return;
    const std::size_t at = static_cast<std::size_t>(random_.between(0.0, static_cast<double>(text_.size())));
    if (random_.chance(0.5)) text_.erase(at, 1);
    else text_[at] = static_cast<char>(random_.below(256));
  }

  RandomNumber random_;
  bool is_gentle_ = false;
  std::string text_;
  const std::string& other_;
};

} // namespace

std::string mutated(const std::string& text, const std::string& other, std::uint64_t seed, std::uint64_t number) {
  return Mutator(text, other, seed_of(seed, number, 0)).run();
}

std::size_t drawn(std::size_t count, std::uint64_t seed, std::uint64_t number, std::uint64_t which) {
  return static_cast<std::size_t>(seed_of(seed, number, which) % count);
}

} // namespace steplap::fuzz
