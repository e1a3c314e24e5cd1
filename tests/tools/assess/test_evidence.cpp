// "energise" needs evidence that the whole voyage was seen: records that lack it, and what the decision says is missing.
#include "driven_scene.h"

#include "tools/assess/record_evidence.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace steplap;
using namespace steplap::assess;
using namespace assess_test;

namespace {

const std::string k_data = std::string(STEPLAP_TEST_DATA) + "/decision/";

AssessmentOptions options_of() {
  AssessmentOptions options;
  options.reading.gravity = "z";
  options.criteria = k_data + "crit.toml";
  options.sampling.samples = 0;
  options.estimating = Estimating::never;
  options.accepted = {Evidence::coverage};
  return options;
}

Assessment assessed(const std::string& file, const AssessmentOptions& options) {
  return assess::assess({k_data + file + ".csv"}, {std::string(STEPLAP_MODELS) + "/assess/transformer.toml"}, options);
}

bool lacks(const Assessment& a, Evidence item) {
  return std::any_of(a.missing.begin(), a.missing.end(), [&](const MissingEvidence& m) { return m.item == item; });
}

std::string text_of(const std::vector<std::string>& times) {
  std::string text = "time [s],x [g],y [g],z [g]\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double n = 1e-3 * std::sin(7.0 * static_cast<double>(i));
    char row[96];
    std::snprintf(row, sizeof row, "%s,%.5f,%.5f,%.5f\n", times[i].c_str(), n, n, 1.0 - n);
    text += row;
  }
  return text;
}

} // namespace

TEST_CASE("what a record hides leaves the decision open, says what is missing, and is taken upon oneself by one word") {
  const std::pair<const char*, Evidence> rows[] = {
      {"g_lat", Evidence::axis},     {"f_rot", Evidence::axis},         {"h_drop2", Evidence::gaps},
      {"f_endmid", Evidence::cut},   {"f_beginmid", Evidence::cut},     {"g_diesmid", Evidence::dead},
      {"g_deadlsb", Evidence::dead}, {"f_clipsoft", Evidence::clipped}, {"f_comment_gap", Evidence::comments},
  };
  for (const auto& [file, item] : rows) {
    CAPTURE(file);
    AssessmentOptions options = options_of();
    const Assessment a = assessed(file, options);
    CHECK(a.decision == Decision::open);
    CHECK(lacks(a, item));
    CHECK(a.reason.find(std::string("(accept ") + name_of(item)) != std::string::npos);
    options.accepted.push_back(item);
    options.accepted.push_back(Evidence::axis); // of a dead axis the others read more
    CHECK(assessed(file, options).decision == Decision::energise);
  }
}

TEST_CASE("the same shock whole is a return, and in rows that are read in a wrong unit the decision is open") {
  CHECK(assessed("h_full", options_of()).decision == Decision::send_back);
  AssessmentOptions options = options_of();
  options.reading.gravity.reset();
  options.reading.read.unit = "m/s^2";
  options.reading.rest = std::array{0.0, 1.0};
  const Assessment a = assessed("f_unit", options);
  CHECK(a.decision == Decision::open);
  CHECK(lacks(a, Evidence::unit));
}

TEST_CASE("without a voyage, with more of it than was recorded, and of silence the decision is open") {
  AssessmentOptions options = options_of();
  options.accepted.clear();
  for (const char* voyage : {"", "0,2", "0,3", "-1,2", "2016-01-04 10:00, 2016-01-04 11:00"}) {
    CAPTURE(voyage);
    options.voyage = parse_voyage(voyage);
    const Assessment a = assessed("g_silent", options);
    CHECK(a.decision == Decision::open);
    CHECK(lacks(a, Evidence::coverage));
  }
  options.voyage = parse_voyage("0,9");
  CHECK(assessed("s_16_0.7", options).decision == Decision::energise);
  options.voyage = parse_voyage("0,9.1");
  CHECK(assessed("s_16_0.7", options).decision == Decision::open);
  for (const char* none : {"1", "2,1", "a,b", "2016-01-04, 2016-01-05", "2016-01-04 10:00Z, 2016-01-04 11:00"})
    CHECK_FALSE(parse_voyage(none));
}

TEST_CASE("sustained vibration is run whole, from rest to rest") {
  const Assessment strong = assessed("s_10_0.5", options_of());
  CHECK(strong.decision == Decision::send_back);
  CHECK(strong.summary.least_margin == doctest::Approx(1.01).epsilon(0.02)); // that of the record run whole
  const Assessment harmless = assessed("s_16_0.7", options_of());            // slipped when its run began amid the vibration
  CHECK(harmless.decision == Decision::energise);
  CHECK(harmless.summary.least_margin == doctest::Approx(2.49).epsilon(0.02));
  REQUIRE(harmless.events.size() == 1);
  // 0.7 g at 16 Hz: the vibration begins and ends in its window.
  const Window& window = harmless.records[0].events[0].window;
  CHECK(window.lead > 0);
  CHECK(window.tail > 0);
}

TEST_CASE("a filter that takes away what joints feel leaves the decision open") {
  AssessmentOptions options = options_of();
  options.reading.frequency_class = 10.0;
  const Assessment narrow = assessed("d_1.3", options);
  CHECK(narrow.decision == Decision::open);
  CHECK(lacks(narrow, Evidence::bandwidth));
  options.reading.frequency_class = 60.0;
  CHECK(assessed("d_1.3", options).decision == Decision::send_back);
}

TEST_CASE("rows that are missing are counted, and times that are rounded keep their rate") {
  const Folder folder;
  const std::string file = folder.file("times.csv");
  const auto rate_of_times = [&](double rate, int decimals, const std::vector<int>& lost) {
    std::vector<std::string> times;
    for (int i = 0; i < 600; ++i) {
      char time[32];
      std::snprintf(time, sizeof time, "%.*f", decimals, i / rate);
      if (std::find(lost.begin(), lost.end(), i) == lost.end()) times.emplace_back(time);
    }
    assess_test::write(file, text_of(times));
    EventReading reading;
    reading.gravity = "z";
    const RecordEvents record = read_without_events(file, reading);
    std::size_t rows = 0;
    for (const Hole& hole : record.recording.facts.hole_list) rows += hole.rows;
    CHECK(rows == lost.size());
    return record.recording.layout.time.rate;
  };
  // Times of 600 rows rounded to 1 ms: half of it at either end of 5.6 s.
  CHECK(rate_of_times(107.613, 3, {}) == doctest::Approx(107.613).epsilon(2e-4));
  CHECK(rate_of_times(107.613, 3, {50, 51, 300}) == doctest::Approx(107.613).epsilon(2e-4));
  CHECK(rate_of_times(100.0, 3, {300, 301}) == doctest::Approx(100.0).epsilon(1e-12));
  CHECK(rate_of_times(100.0, 3, {5, 9, 300, 301, 450}) == doctest::Approx(100.0).epsilon(1e-12));
}

TEST_CASE("last lines: ordinary ends are known, all others are not") {
  for (const char* good :
       {";stopped, by button", "# end of file", "; EOF", "* Recording stopped by user at 10:25:14", "#", "; 4000 samples, done"})
    CHECK_MESSAGE(is_ordinary_end(good), good);
  for (const char* other :
       {"; low battery", "# stopped: voltage", "; Speicher voll", "# restarted after power failure", "; not complete", "; E07",
        "# overflow", "; ferme", "; \xe7\xb5\x82\xe4\xba\x86", "; 17", "# reset", "; sensor fault", "; file system full"})
    CHECK_MESSAGE(!is_ordinary_end(other), other);
}

TEST_CASE("blocks with time between them, and a comment among rows, leave the decision open") {
  const Folder folder;
  const std::string file = folder.file("blocks.csv"), model = folder.file("block.toml");
  assess_test::write(model, block_text(0.5, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n"));
  const auto block = [](double from) {
    std::string text;
    for (int i = 0; i < 500; ++i) {
      const double n = 1e-3 * std::sin(7.0 * i), t = from + i / 500.0, x = 0.5 * std::sin(20.0 * std::numbers::pi * t);
      char row[96];
      std::snprintf(row, sizeof row, "%.4f,%.5f,%.5f,%.5f\n", t, i < 100 || i > 400 ? n : x + n, n, 1.0 - n);
      text += row;
    }
    return text;
  };
  const std::string names = "time [s],x [g],y [g],z [g]\n";
  AssessmentOptions options = options_of();
  options.criteria = folder.file("criteria.toml");
  assess_test::write(options.criteria,
                     "name = \"models\"\n[[criterion]]\nname = \"models\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n");
  const auto made = [&](const std::string& text) {
    assess_test::write(file, text);
    return assess::assess({file}, {model}, options);
  };
  CHECK(made(names + block(0.0) + names + block(1.0)).decision == Decision::energise);
  CHECK(lacks(made(names + block(0.0) + names + block(61.0)), Evidence::gaps));
  CHECK(lacks(made(names + block(0.0) + "# overheated\n" + block(1.0)), Evidence::comments));
  CHECK(made(names + block(0.0) + block(1.0) + "# end of file\n").decision == Decision::energise);
}
