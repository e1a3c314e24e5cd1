// Damaged files: nothing crashes, and no change of a value goes unseen.
#include "record_file.h"

#include <doctest/doctest.h>

#include <algorithm>

using namespace steplap;
using namespace steplap::test;

namespace {

bool is_same(const Segments& a, const Segments& b) {
  const auto same = [](const Sample& p, const Sample& q) { return p.t == q.t && p.a == q.a; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](const auto& p, const auto& q) { return std::equal(p.begin(), p.end(), q.begin(), q.end(), same); });
}

// What a file is read to; nothing if it is refused. Anything thrown beside a refusal ends the test.
std::optional<ReadResult> attempt(const std::string& text, const ReadOptions& options) {
  try {
    return read_text(text, options);
  } catch (const RecordError& error) {
    CHECK(std::string(error.what()).starts_with("record.csv"));
    return std::nullopt;
  }
}

} // namespace

TEST_CASE("files with random bytes changed, taken out, doubled or cut off are read or refused") {
  std::mt19937 random(7);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  std::size_t refused = 0, read = 0;
  for (std::uint32_t file = 0; file < 40; ++file) {
    const MadeFile made = make_file(random_manner(random), file);
    ReadOptions options;
    for (const Open& open : made.open) open.settle(options);
    for (int i = 0; i < 25; ++i) {
      std::string text = made.text;
      for (std::size_t changes = 1 + below(3); changes > 0 && !text.empty(); --changes) {
        const std::size_t at = below(text.size()), length = 1 + below(12);
        switch (below(5)) {
        case 0: text[at] = static_cast<char>(below(256)); break;
        case 1: text[at] = "0123456789.,;-+eE \t\r\n\"#*:/"[below(27)]; break;
        case 2: text.erase(at, length); break;
        case 3: text.insert(at, text.substr(below(text.size()), length)); break;
        default: text.resize(at + 1);
        }
      }
      CAPTURE(text);
      attempt(text, options) ? ++read : ++refused;
    }
  }
  CHECK(read > 50); // both happen, or the test sees one side only
  CHECK(refused > 50);
}

TEST_CASE("a digit of a time or an acceleration that is changed changes what is read, or is refused") {
  std::mt19937 random(11);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  std::size_t read = 0;
  for (std::uint32_t file = 0; file < 40; ++file) {
    Manner manner = random_manner(random);
    manner.encoding = Encoding::utf8; // digits are looked up in the text
    const MadeFile made = make_file(manner, file);
    ReadOptions options;
    for (const Open& open : made.open) open.settle(options);
    const ReadResult whole = read_text(made.text, options);
    for (int i = 0; i < 25; ++i) {
      const auto [begin, length] = made.values[below(made.values.size())];
      std::string text = made.text;
      std::size_t at = begin + below(std::max<std::size_t>(length, 1));
      if (length == 0 || text[at] < '0' || text[at] > '9') continue;
      const char digit = static_cast<char>('0' + (text[at] - '0' + 1 + static_cast<int>(below(9))) % 10);
      text[at] = digit;
      const std::string what = text_of(manner), field = text.substr(begin, length), before = made.text.substr(begin, length);
      CAPTURE(what);
      CAPTURE(before);
      CAPTURE(field);
      const auto result = attempt(text, options);
      if (!result) continue;
      ++read;
      CHECK_FALSE(is_same(result->segments, whole.segments));
    }
  }
  CHECK(read > 100);
}

TEST_CASE("a file that is cut at any byte is refused, or read to the rows before the cut") {
  for (const Scale scale : {Scale::g, Scale::counts_with_scale})
    for (const char delimiter : {',', ' '}) {
      Manner manner;
      manner.scale = scale;
      manner.delimiter = delimiter;
      manner.comment = '#';
      const std::string text = make_file(manner, 5).text;
      const std::vector<Sample> whole = read_text(text, {}).segments.at(0);
      std::size_t read = 0;
      for (std::size_t length = 0; length < text.size(); ++length) {
        const auto result = attempt(text.substr(0, length), {});
        if (!result) continue;
        ++read;
        CAPTURE(length);
        REQUIRE(result->segments.size() == 1);
        const std::vector<Sample>& samples = result->segments[0];
        // The digits that a whole number has lost cannot be known: that it may have is said.
        const bool may_lack_digits = scale != Scale::g && result->recording.facts.unended_line > 0;
        const std::size_t sure = samples.size() - (may_lack_digits ? 1 : 0);
        REQUIRE(samples.size() <= whole.size());
        bool is_same = true;
        for (std::size_t i = 0; i < sure; ++i) is_same &= samples[i].t == whole[i].t && samples[i].a == whole[i].a;
        CHECK(is_same);
      }
      CHECK(read > text.size() / 2);
    }
}
