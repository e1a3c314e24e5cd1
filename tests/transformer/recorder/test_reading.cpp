// Every way of writing a recorder's file, alone and mixed: what is read is what was written, and what the file leaves open is asked for.
#include "record_file.h"

#include <doctest/doctest.h>

#include <algorithm>

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

namespace {

// A file as inertial recorders of Gulf Coast Data Concepts write it: its sensors say their units in comments, and some rows have columns
// that no line names.
std::string imu_file(bool begins_long) {
  std::string text =
      ";Title, http://www.gcdataconcepts.com, HAM-IMU\n;MPU6050, SR, 100,Hz, Units, mG, mdps\n;BMP280, SI, 1,sec, Units, Pa\n"
      ";Time, Ax, Ay, Az\n";
  for (int i = 0; i < 20; ++i) {
    text += "0." + std::string(i < 10 ? "0" : "") + std::to_string(i) + "," + std::to_string(10 + i) + ",20,1000";
    text += (i % 5 == 0) == begins_long ? ",101325,21500\n" : "\n";
  }
  return text;
}

bool tells(const Recording& recording, const std::string& words) {
  const std::vector<std::string> lines = facts_text(recording);
  return std::any_of(lines.begin(), lines.end(), [&](const std::string& line) { return line.find(words) != std::string::npos; });
}

} // namespace

TEST_CASE("rows longer than the header are read by the names, and the columns left out are named") {
  for (const bool begins_long : {true, false}) {
    const ReadResult read = read_text(imu_file(begins_long));
    REQUIRE(read.segments.size() == 1);
    REQUIRE(read.segments[0].size() == 20);
    CHECK(read.segments[0][7].a[0] == doctest::Approx(0.017 * 9.80665).epsilon(1e-12));
    CHECK(read.segments[0][7].a[2] == doctest::Approx(9.80665).epsilon(1e-12));
    CHECK(read.recording.layout.axes[0].unit_source == "line 2");
    CHECK(tells(read.recording, "columns 5 to 6, which have no names, were left out"));
  }
  // One long row may be two that ran together.
  CHECK(refusal(imu_file(true) + "0.20,30,20,1000,0.21,31,20,1000\n", {}, 25).find("8 fields") != std::string::npos);
}

TEST_CASE("two sensors with different units of acceleration leave the unit open") {
  std::string text = imu_file(true);
  text.replace(text.find("Units, Pa"), 9, "Units, g");
  CHECK(names_option(refusal(text, {}, 0), "--counts-per-g"));
}

TEST_CASE("the stretch at rest that is given tells of gravity, not the first second") {
  std::string text = "Time[s],Ax[g],Ay[g],Az[g]\n";
  for (int i = 0; i < 500; ++i) {
    const double t = 0.01 * i, turned = t < 2.5 ? 0.5 : 1.0; // handled before it is mounted
    text += std::to_string(t) + ",0.001,0.002," + std::to_string(turned) + "\n";
  }
  ReadOptions options;
  CHECK(tells(read_text(text, options).recording, "the first second reads 0.5 g"));
  options.rest = std::array{3.0, 4.0};
  const ReadResult read = read_text(text, options);
  CHECK(read.recording.facts.axes[2].rest == doctest::Approx(9.80665).epsilon(1e-12));
  CHECK(tells(read.recording, "from 3 s to 4 s it reads 1 g, mostly along z"));
}

TEST_CASE("a value that no transport gives is pointed out, in waveforms and in lists of peaks") {
  const std::string rows = "Time[s],Ax[g]\n0.00,0.1\n0.01,0.2\n0.02,2.4e7\n0.03,0.2\n";
  CHECK(tells(read_text(rows).recording, "Axis x reads 2.4e+07 g, which no transport gives"));
  const std::string peaks = "Date/Time,X Peak (g),Duration (ms)\n2016-01-04 10:25:17,3.1,50\n2016-01-04 10:25:20,2.4e7,120\n";
  CHECK(tells(read_text(peaks).recording, "The entry in line 3 reads 2.4e+07 g"));
  CHECK(impossible_reading(read_text("Time[s],Ax[g]\n0.00,0.1\n0.01,200\n0.02,0.1\n").recording).empty());
}
