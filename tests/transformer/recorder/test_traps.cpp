// Files that nothing can settle, or that look like what they are not: refused at the place, with what to do.
#include "record_file.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace steplap;
using namespace steplap::test;

namespace {

const std::string k_names = "Time[s],Ax[g],Ay[g],Az[g]\n";
const std::string k_rows = "0.00,0.1,0.2,1.0\n0.01,0.2,0.3,1.1\n0.02,0.3,0.4,1.2\n";

void check_refused(const std::string& text, std::size_t line, const std::string& words, const ReadOptions& options = {}) {
  CAPTURE(text);
  const std::string message = refusal(text, options, line);
  CHECK_MESSAGE(message.find(words) != std::string::npos, message);
}

} // namespace

TEST_CASE("values that are none are refused where they stand") {
  check_refused(k_names + k_rows + "0.03,0.4,abc,1.3\n", 5, ":10: 'abc' is not a finite number");
  check_refused(k_names + k_rows + "0.03,0.4,inf,1.3\n", 5, ":10: 'inf' is not a finite number");
  check_refused(k_names + k_rows + "0.03,0.4,1e999,1.3\n", 5, "is not a finite number");
  check_refused(k_names + k_rows + ",0.4,0.5,1.3\n", 5, ":1: The row has no time");
  check_refused(k_names + k_rows + "0.03,0.4,0.5,1.3,0.04,0.4,0.5,1.3\n", 5, "This row has 8 fields, 4 were expected");
  check_refused(k_names + k_rows + "0.03,0.4,\"0.5,1.3\n", 5, "a quote is not closed");
  check_refused(k_names + k_rows + "0.03,0.4\n", 5, "--missing");
  check_refused(k_names + k_rows + "0.03,0.4,1.234,5\n0.04,0.4,1,2,3\n", 6, "5 fields, 4 were expected");
  check_refused("Time;Ax[g];Ay[g]\n2016-01-04 10:00:00.00;0.1;0.2\n2016-01-04 10:00:00.01;0.1;0.2\n2016-02-30 10:00:00.02;0.1;0.2\n", 4,
                "'2016-02-30 10:00:00.02' is");
}

TEST_CASE("a zero byte and half a character of UTF-16 are refused") {
  check_refused(k_names + "0.00,0.1,0.2" + std::string(1, '\0') + ",1.0\n", 2, "A zero byte");
  CHECK_THROWS_WITH_AS(static_cast<void>(read_text(std::string("\xFF\xFE"
                                                               "1\0"
                                                               "2",
                                                               5))),
                       doctest::Contains("odd number of bytes"), RecordError);
  CHECK_THROWS_WITH_AS(static_cast<void>(read_text("")), doctest::Contains("The file is empty"), RecordError);
}

TEST_CASE("an acceleration without an axis is asked for") {
  const std::string text = "Time[s],Acceleration[g]\n0.00,0.1\n0.01,0.2\n0.02,0.3\n";
  check_refused(text, 1, "Give --x, --y or --z");
  ReadOptions options;
  options.z = "-2";
  const ReadResult read = read_text(text, options);
  REQUIRE(read.recording.layout.axes.size() == 1);
  CHECK(read.recording.layout.axes[0].axis == 'z');
  CHECK(read.segments.at(0).at(1).a[0] == doctest::Approx(-0.2 * 9.80665).epsilon(1e-15));
}

TEST_CASE("two columns that may be the same axis are asked for") {
  check_refused("Time[s],Ax[g],Acc X[g]\n0.00,0.1,1\n0.01,0.2,1\n0.02,0.3,1\n", 1, "Choose one with --x");
}

TEST_CASE("columns without names are named x, y and z only if three are left") {
  ReadOptions options;
  options.time = "1";
  check_refused("0.00,0.1,0.2\n0.01,0.2,0.4\n0.02,0.3,0.1\n", 1, "--x 2", options);
  options.time_unit = "s";
  options.unit = "g";
  CHECK(read_text("0.00,0.1,0.2,0.3\n0.01,0.2,0.4,0.5\n0.02,0.3,0.1,0.4\n", options).recording.layout.axes.size() == 3);
}

TEST_CASE("a unit of time is never guessed from the size of the numbers") {
  check_refused("Time,Ax[g]\n1451903114.00,0.1\n1451903114.01,0.2\n1451903114.02,0.3\n", 2, "--time-unit epoch.");
  check_refused("Time,Ax[g]\n1451903114000,0.1\n1451903114010,0.2\n1451903114020,0.3\n", 2, "--time-unit \"epoch ms\".");
  check_refused("Date,Ax[g]\n42373.434189814,0.1\n42373.434189930,0.2\n42373.434190046,0.3\n", 2, "--time-unit days.");
  check_refused("Time,Ax[g]\n0,0.1\n10,0.2\n20,0.3\n", 2, "--time-unit s, ms");
}

TEST_CASE("a column T is no time unless it is said, as it may be a temperature") {
  check_refused("T,Ax[g]\n21.5,0.1\n21.6,0.2\n21.7,0.3\n", 2, "--rate HZ");
}

TEST_CASE("the line that says when the record starts is no row") {
  const std::string rows = "TIME;ACC x;ACC y;ACC z\n;g;g;g\n2016-01-04 10:25:14.00;0.1;0.2;1.0\n2016-01-04 10:25:14.02;0.2;0.3;1.1\n";
  for (const std::string& head :
       {std::string("*CREATOR\nMSR145\n*STARTTIME\n2016-01-04;10:25:14\n*MODUL\n*NAME\n*DATA\n"), std::string("2016-01-04;10:25:14\n")}) {
    const ReadResult read = read_text(head + rows);
    REQUIRE(read.segments.size() == 1);
    REQUIRE(read.segments[0].size() == 2);
    CHECK(read.segments[0][1].t == doctest::Approx(0.02).epsilon(1e-12));
  }
  check_refused("0.1;0.2;0.3;0.4\n" + rows, 1, "stands before line 2");
}

TEST_CASE("a last line without line break is kept if it has all fields, and said") {
  const auto lines = [](const ReadResult& read) {
    std::string text;
    for (const std::string& line : facts_text(read.recording)) text += line + "\n";
    return text;
  };
  const ReadResult kept = read_text(k_names + k_rows + "0.03,0.4,0.5,1.3");
  CHECK(kept.segments.at(0).size() == 4);
  CHECK(lines(kept).find("The last line (5) does not end with a line break. It has all fields, and its last number as many decimals as "
                         "those before: it was kept.") != std::string::npos);
  for (const char* cut : {"0.03,0.4,0.5,1.", "0.03,0.4,0.5,1", "0.03,0.4,0.5,-", "0.03,0.4,0.5,", "0.03,0.4,0.5", "0.03,0.", "0"}) {
    CAPTURE(cut);
    const ReadResult left_out = read_text(k_names + k_rows + cut);
    CHECK(left_out.segments.at(0).size() == 3);
    CHECK(lines(left_out).find("The last line (5) is cut: it was left out.") != std::string::npos);
  }
}

TEST_CASE("a last number without line break that may lack digits is left out, and said") {
  const std::string counts = "Time[s],Ax[counts],Ay[counts],Az[counts]\n0.00,1,2,2048\n0.01,3,4,2050\n0.02,5,6,2049";
  ReadOptions options;
  options.counts_per_g = 2048.0;
  for (std::size_t less = 0; less < 4; ++less) CHECK(read_text(counts.substr(0, counts.size() - less), options).segments.at(0).size() == 2);
  CHECK(read_text(counts + "\n", options).segments.at(0).size() == 3);
  const std::string uneven = k_names + "0.00,0.1,0.2,1.0\n0.01,0.2,0.3,1.25\n0.02,0.3,0.4,1.12"; // "%g": it may have been 1.125
  CHECK(read_text(uneven).segments.at(0).size() == 2);
}

TEST_CASE("of rows of one time the first or the last is kept, as asked") {
  const std::string text =
      k_names +
      "0.00,0.1,0.2,1.0\n0.01,0.2,0.3,1.1\n0.01,0.3,0.3,1.1\n0.01,0.4,0.3,1.1\n0.02,0.5,0.4,1.2\n0.03,0.6,0.4,1.2\n0.03,0.7,0.4,1.2\n";
  for (const bool is_last : {false, true}) {
    ReadOptions options;
    options.repeated = is_last ? IfRepeated::last : IfRepeated::first;
    const ReadResult read = read_text(text, options);
    REQUIRE(read.segments.at(0).size() == 4);
    const double expected[] = {0.1, is_last ? 0.4 : 0.2, 0.5, is_last ? 0.7 : 0.6};
    for (std::size_t i = 0; i < 4; ++i) CHECK(read.segments[0][i].a[0] == doctest::Approx(expected[i] * 9.80665).epsilon(1e-12));
    CHECK(read.recording.facts.rows == 4);
    CHECK(read.recording.facts.repeated.count == 3);
  }
}

TEST_CASE("quoted numbers with a decimal comma are read where a comma parts them") {
  const ReadResult read =
      read_text("\"Time [s]\",\"X [g]\",\"Y [g]\",\"Z "
                "[g]\"\n\"0,00\",\"0,1250\",\"-0,2\",\"1,0\"\n\"0,01\",\"0,2500\",\"0,3\",\"1,1\"\n\"0,02\",\"0,5000\",\"0,4\",\"1,2\"\n");
  REQUIRE(read.segments.at(0).size() == 3);
  CHECK(read.segments[0][1].t == doctest::Approx(0.01).epsilon(1e-12));
  CHECK(read.segments[0][2].a[0] == doctest::Approx(0.5 * 9.80665).epsilon(1e-12));
  CHECK(read.segments[0][0].a[1] == doctest::Approx(-0.2 * 9.80665).epsilon(1e-12));
}

TEST_CASE("a last entry of a list of peaks that is cut is left out") {
  const std::string list =
      "Timestamp;Max [g];Duration [ms]\n04.01.2016 10:25:17;3.12;50.0\n04.01.2016 10:25:20;1.61;120.0\n04.01.2016 10:25:24;1.";
  CHECK(read_text(list).recording.peaks.size() == 2);
}

TEST_CASE("a row that is left out keeps its place where rows count the time") {
  ReadOptions options;
  options.missing = IfMissing::skip;
  options.rate = 100.0;
  const ReadResult read = read_text("Ax[g],Ay[g]\n0.1,0.2\nNaN,0.3\n0.3,0.4\n0.4,0.5\n", options);
  REQUIRE(read.segments.at(0).size() == 3);
  CHECK(read.segments[0][1].t == doctest::Approx(0.02).epsilon(1e-12));
}

TEST_CASE("two signs of decimals in one file are asked for, and then refused where the other stands") {
  const std::string text = "Time[s];Ax[g]\n0,00;0,1234\n0,01;0.2345\n0,02;0,3456\n";
  check_refused(text, 3, "--decimal comma or --decimal point");
  ReadOptions options;
  options.decimal = ',';
  check_refused(text, 3, "'0.2345' is", options);
}

TEST_CASE("a comma that may part thousands is asked for") {
  check_refused("Time[s];Ax[mG]\n0;1,234\n1;2,345\n2;3,456\n", 2, "--decimal comma");
}

TEST_CASE("dates and times of day in all their forms give the time from the first row") {
  for (const char* text :
       {"Date;Time;Ax[g]\n04.01.2016;23:59:59.98;0.1\n04.01.2016;23:59:59.99;0.2\n05.01.2016;00:00:00.00;0.3\n",
        "Time;Ax[g]\n23:59:59.98;0.1\n23:59:59.99;0.2\n00:00:00.00;0.3\n",
        "Time;Ax[g]\n01/31/2016 11:59:59.98 PM;0.1\n01/31/2016 11:59:59.99 PM;0.2\n02/01/2016 12:00:00.00 AM;0.3\n",
        "Time;Ax[g]\n2016-02-28T23:59:59.98+01:00;0.1\n2016-02-28T23:59:59.99+01:00;0.2\n2016-02-29T00:00:00.00+01:00;0.3\n",
        "Time;Ax[g]\n31-Dec-2015 23:59:59,98;0.1\n31-Dec-2015 23:59:59,99;0.2\n01-Jan-2016 00:00:00,00;0.3\n"}) {
    CAPTURE(text);
    const ReadResult read = read_text(text);
    REQUIRE(read.segments.size() == 1);
    REQUIRE(read.segments[0].size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(std::abs(read.segments[0][i].t - 0.01 * static_cast<double>(i)) < 1e-12);
      CHECK(std::abs(read.segments[0][i].a[0] - 0.1 * static_cast<double>(i + 1) * 9.80665) < 1e-12);
    }
  }
}

TEST_CASE("with a deadband the value before is held up to the sample that differs") {
  const ReadResult read = read_text(
      ";Deadband, 5, counts\n;SampleRate, 100, Hz\n;Accel, 100, 1000, 16, g\n;Headers, time,Ax\n0.00,100\n0.01,200\n0.05,300\n0.06,400\n");
  REQUIRE(read.segments.size() == 1);
  REQUIRE(read.segments[0].size() == 5); // one row more, a step before the change
  CHECK(read.segments[0][2].t == doctest::Approx(0.04).epsilon(1e-12));
  CHECK(read.segments[0][2].a[0] == doctest::Approx(0.2 * 9.80665).epsilon(1e-12));
  CHECK(read.recording.facts.held.count == 1);
}

TEST_CASE("a time beyond the calendar is refused") {
  check_refused("Time [days],Ax[g]\n34401485539999,0.1\n34401485540000,0.2\n34401485540001,0.3\n", 2, "beyond the year 2200");
  check_refused("Time [s],Ax[g]\n14519031140,0.1\n14519031141,0.2\n14519031142,0.3\n", 2, "--time-unit");
}
