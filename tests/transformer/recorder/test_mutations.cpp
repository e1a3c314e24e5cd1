// Damaged files: nothing crashes, and no change of a value goes unseen.
#include "damage.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::test;

TEST_CASE("files with random bytes changed, taken out, doubled or cut off are read or refused") {
  std::mt19937 random(7);
  std::size_t refused = 0, read = 0;
  for (std::uint32_t file = 0; file < 40; ++file) {
    const Victim victim = random_victim(random, file, false);
    for (int i = 0; i < 25; ++i) {
      const Damaged damaged = random_bytes(random, victim);
      CAPTURE(damaged.text);
      CHECK(damaged.fault == "");
      damaged.came == Came::read ? ++read : ++refused;
    }
  }
  CHECK(read > 50); // both happen, or the test sees one side only
  CHECK(refused > 50);
}

TEST_CASE("a digit of a time or an acceleration that is changed changes what is read, or is refused") {
  std::mt19937 random(11);
  std::size_t read = 0;
  for (std::uint32_t file = 0; file < 40; ++file) {
    const Victim victim = random_victim(random, file, true);
    const ReadResult whole = read_text(victim.made.text, victim.options);
    for (int i = 0; i < 25; ++i) {
      const Damaged damaged = other_digit(random, victim, whole.segments);
      CHECK(damaged.fault == "");
      read += damaged.came == Came::read;
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
      const Segments whole = read_text(text, {}).segments;
      std::size_t read = 0;
      for (std::size_t length = 0; length < text.size(); ++length) {
        const Damaged damaged = cut_short(text, length, {}, whole);
        CAPTURE(length);
        CHECK(damaged.fault == "");
        read += damaged.came == Came::read;
      }
      CHECK(read > text.size() / 2);
    }
}
