// Every way of writing a recorder's file, alone and mixed: what is read is what was written, and what the file leaves open is asked for.
#include "record_file.h"

#include <doctest/doctest.h>

using namespace steplap;
using namespace steplap::test;

namespace {

void check_manner(const Manner& manner, std::uint32_t seed) {
  const std::string what = text_of(manner);
  CAPTURE(what);
  const MadeFile made = make_file(manner, seed);
  ReadOptions options;
  const ReadResult read = read_and_answer(made, options);
  check_same(read.segments, made.segments, made.time_error);
  const ReadFacts& facts = read.recording.facts;
  CHECK((facts.cut_line > 0) == (manner.ending == Ending::cut_row));
  CHECK((facts.unended_line > 0) == (manner.ending == Ending::no_line_break));
  CHECK((facts.comments.count > 0) == (manner.trap == RowTrap::comment || manner.ending == Ending::comment));
  if (manner.trap == RowTrap::clipped) CHECK((facts.axes[0].flat_longest == 5 || facts.axes[0].beyond_range.count == 5));
}

} // namespace

TEST_CASE("each way of writing alone is read to the values that were written") {
  std::vector<Manner> manners(1);
  const auto add = [&](const auto& change) {
    manners.emplace_back();
    change(manners.back());
  };
  for (const char delimiter : {',', ';', '\t', ' '})
    for (const char decimal : {'.', ','}) add([&](Manner& m) { m.delimiter = delimiter, m.decimal = decimal; });
  for (int i = 0; i < 5; ++i) add([&](Manner& m) { m.encoding = static_cast<Encoding>(i); });
  for (const char* end : {"\r\n", "\r"}) add([&](Manner& m) { m.line_end = end; });
  for (const char comment : {'#', '*', ';'})
    for (const bool are_names : {false, true}) add([&](Manner& m) { m.comment = comment, m.are_names_comment = are_names; });
  add([](Manner& m) { m.has_names = false; });
  for (int clock = 0; clock < 8; ++clock)
    for (const bool is_said : {false, true})
      for (const bool has_rate : {false, true})
        add([&](Manner& m) {
          m.clock = static_cast<Clock>(clock), m.says_clock_unit = is_said, m.has_rate = has_rate && m.clock != Clock::epoch;
        });
  for (int scale = 0; scale < 5; ++scale)
    for (int place = 0; place < 4; ++place)
      if (scale < 3 || place == 0 || place == 3)
        add([&](Manner& m) { m.scale = static_cast<Scale>(scale), m.unit_place = static_cast<UnitPlace>(place); });
  for (int trap = 0; trap < 8; ++trap)
    for (int variant = 0; variant < 2; ++variant)
      for (const Clock clock : {Clock::seconds, Clock::iso, Clock::none})
        add([&](Manner& m) { m.trap = static_cast<RowTrap>(trap), m.variant = variant, m.clock = clock, m.delimiter = ';'; });
  for (int ending = 0; ending < 4; ++ending) add([&](Manner& m) { m.ending = static_cast<Ending>(ending); });
  add([](Manner& m) { m.is_ragged = true; });
  std::uint32_t seed = 1;
  for (const Manner& manner : manners) check_manner(manner, seed++);
}

TEST_CASE("random mixtures of all ways are read to the values that were written, after questions that have an answer") {
  std::mt19937 random(20260107);
  for (std::uint32_t i = 0; i < 400; ++i) check_manner(random_manner(random), i);
}
