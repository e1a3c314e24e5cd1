// "energise" needs evidence that the whole voyage was seen: records that lack it, and what the decision says is missing.
#include "driven_scene.h"

#include "tools/assess/record_evidence.h"
#include "tools/study/counter_random.h"
#include "transformer/recorder/fields.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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

/// Rows of a recorder that travels: vibration of 0.1 g for a second, then what `x` gives (g), and noise of 5 mg in steps of 0.01 mg.
struct Journey {
  explicit Journey(
      double rate, const std::function<double(double)>& x = [](double) { return 0.0; }) {
    study::CounterRandom random(5, 1);
    std::uint32_t next = 0;
    for (long i = 0; i < std::lround(4.0 * rate); ++i) {
      const double t = static_cast<double>(i) / rate;
      const double s = 0.1 * std::sin(20.0 * std::numbers::pi * t) * std::sin(std::numbers::pi * std::clamp(t - 0.5, 0.0, 1.0));
      std::array<double, 3> a{s + x(t), 0.5 * s, 1.0};
      for (double& value : a) value += 0.01 * (random.uniform(1, next++) - 0.5);
      rows.push_back({t, a});
    }
  }
  [[nodiscard]] std::string csv() const {
    std::string text = "time [s],x [g],y [g],z [g]\n";
    for (const auto& [t, a] : rows) {
      char row[96];
      std::snprintf(row, sizeof row, "%.4f,%.5f,%.5f,%.5f\n", t, a[0], a[1], a[2]);
      text += row;
    }
    return text;
  }
  /// Replaces the values of the rows from `from` to before `to`, s.
  void replace(double from, double to, const std::function<void(std::size_t, std::array<double, 3>&)>& by) {
    std::size_t n = 0;
    for (auto& [t, a] : rows)
      if (t >= from && t < to) by(n++, a);
  }
  std::vector<std::pair<double, std::array<double, 3>>> rows;
};

/// A block with a friction of 0.5, which holds in all that these records show, and a folder for a record.
struct HoldingBlock {
  HoldingBlock() {
    assess_test::write(model, block_text(0.5, "[[acceptance]]\nname = \"slide\"\nchannel = \"floor.slide\"\nwithin = \"1 m\"\n"));
    options.criteria = folder.file("criteria.toml");
    assess_test::write(options.criteria,
                       "name = \"models\"\n[[criterion]]\nname = \"models\"\nquantity = \"acceptance\"\noutcome = \"inspect\"\n");
  }
  [[nodiscard]] Assessment made(const std::string& text) const {
    assess_test::write(file, text);
    return assess::assess({file}, {model}, options);
  }
  /// The decision is open, and only this evidence is missing.
  void check_open(const std::string& text, Evidence item) const {
    const Assessment a = made(text);
    CAPTURE(a.reason);
    CHECK(a.decision == Decision::open);
    for (const MissingEvidence& each : a.missing) CHECK((a.is_accepted(each.item) || each.item == item));
  }
  void check_decided(const std::string& text) const {
    const Assessment a = made(text);
    CAPTURE(a.reason);
    CHECK(a.decision == Decision::energise);
  }
  Folder folder;
  std::string file = folder.file("record.csv"), model = folder.file("block.toml");
  AssessmentOptions options = options_of();
};

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

TEST_CASE("an axis without its noise was not measured: it keeps a value or toggles, alone or with all others") {
  const HoldingBlock block;
  using Values = std::array<double, 3>;
  for (const double rate : {100.0, 500.0}) {
    CAPTURE(rate);
    Journey stuck(rate), toggles(rate), frozen(rate), zeros(rate);
    block.check_decided(stuck.csv());
    stuck.replace(2.0, 2.15, [](std::size_t, Values& a) { a[0] = 0.00123; });
    block.check_open(stuck.csv(), Evidence::dead);
    toggles.replace(2.0, 4.0, [](std::size_t n, Values& a) { a[0] = n * n % 7 < 4 ? 0.004 : 0.0; });
    block.check_open(toggles.csv(), Evidence::dead);
    frozen.replace(2.0, 2.15, [](std::size_t, Values& a) { a = {0.00123, -0.00321, 1.00111}; });
    block.check_open(frozen.csv(), Evidence::dead);
    zeros.replace(2.0, 4.0, [](std::size_t, Values& a) { a = {0.0, 0.0, 1.0}; });
    block.check_open(zeros.csv(), Evidence::dead);
  }
}

TEST_CASE("a coarse recorder on a vehicle that stands still is no dead one") {
  const HoldingBlock block;
  // The noise of 5 mg does not show in steps of 20 mg: the axes are constant from 2.3 s on, when nothing moves any more.
  const auto vibration = [](double t) { return 0.2 * std::sin(26.0 * std::numbers::pi * t) * std::clamp((2.3 - t) / 0.3, 0.0, 1.0); };
  Journey coarse(200.0, vibration);
  for (auto& [t, a] : coarse.rows) {
    a[1] += 0.5 * vibration(t), a[2] += 0.5 * vibration(t);
    for (double& value : a) value = 0.02 * std::round(value / 0.02);
  }
  block.check_decided(coarse.csv());
}

TEST_CASE("a record that ends or begins amid vibration is cut, at a zero crossing and in its first swings as well") {
  HoldingBlock block;
  // Swings of 10 Hz that grow from 2 s to 2.3 s to 1.2 g.
  const auto growing = [](double t) {
    return t < 2.0 ? 0.0 : 1.2 * std::min(1.0, (t - 2.0) / 0.3) * std::sin(20.0 * std::numbers::pi * t);
  };
  for (const double rate : {500.0, 2000.0})
    for (const double end : {2.05, 2.10, 2.15}) { // zero crossings
      CAPTURE(rate);
      CAPTURE(end);
      Journey ends(rate, growing), begins = ends;
      std::erase_if(ends.rows, [&](const auto& row) { return row.first > end; });
      block.check_open(ends.csv(), Evidence::cut);
      for (auto& [t, a] : begins.rows) t = 4.0 - t;
      std::reverse(begins.rows.begin(), begins.rows.end());
      std::erase_if(begins.rows, [&](const auto& row) { return row.first < 4.0 - end; });
      block.check_open(begins.csv(), Evidence::cut);
    }
}

TEST_CASE("a tilt is no journey, and an offset that is left in the record is told") {
  HoldingBlock block;
  block.options.accepted.clear();
  block.options.voyage = parse_voyage("0,3.9");
  Journey moved(200.0), still(200.0);
  block.check_decided(moved.csv());
  still.replace(0.0, 4.0, [](std::size_t n, std::array<double, 3>& a) {
    const double noise = 0.002 * std::sin(7.0 * static_cast<double>(n));
    a = {0.08 + noise, noise, 1.07 - noise};
  });
  block.check_open(still.csv(), Evidence::coverage);
  Journey offset(200.0);
  offset.replace(0.0, 4.0, [](std::size_t, std::array<double, 3>& a) { a[0] -= 0.2; });
  block.check_open(offset.csv(), Evidence::unit);
}

TEST_CASE("without times a blank line or a line of signs leaves the time between blocks open, words of a status are comments") {
  const HoldingBlock block;
  const auto text_of_rows = [](const std::string& between, std::size_t every) {
    std::string text = "Sampling rate: 200 Hz\nx [g],y [g],z [g]\n";
    std::size_t n = 0;
    for (const auto& [t, a] : Journey(200.0).rows) {
      char row[96];
      std::snprintf(row, sizeof row, "%.5f,%.5f,%.5f\n", a[0], a[1], a[2]);
      text += row;
      if (++n % every == 0) text += between;
    }
    return text;
  };
  block.check_decided(text_of_rows("", 500));
  block.check_decided(text_of_rows("\n", 1)); // an export with doubled line ends
  block.check_open(text_of_rows("\n", 500), Evidence::gaps);
  block.check_open(text_of_rows("***\n", 500), Evidence::gaps);

  const auto with_status = [](const std::string& usual, const std::string& late) {
    std::string text = "time [s],x [g],y [g],z [g],status\n";
    for (const auto& [t, a] : Journey(200.0).rows) {
      char row[96];
      std::snprintf(row, sizeof row, "%.4f,%.5f,%.5f,%.5f,%s\n", t, a[0], a[1], a[2], (t > 2.0 && t < 2.1 ? late : usual).c_str());
      text += row;
    }
    return text;
  };
  block.check_decided(with_status("OK", "OK"));
  block.check_decided(with_status("21.3", "21.4"));
  block.check_open(with_status("OK", "OVERRANGE"), Evidence::comments);
  block.check_open(with_status("", "Sensorfehler"), Evidence::comments);
}

TEST_CASE("a low-pass of the recorder that its file states limits the bandwidth") {
  const HoldingBlock block;
  const std::string rows = Journey(200.0).csv();
  block.check_decided("# Low-pass filter: 80 Hz\n" + rows);
  block.check_open("# Low-pass filter: 10 Hz\n" + rows, Evidence::bandwidth);
  block.check_open("# Bandwidth,0.02,kHz\n" + rows, Evidence::bandwidth);
}

TEST_CASE("a stretch named as rest in which the vehicle brakes is told, because its mean hides the braking") {
  HoldingBlock block;
  block.options.reading.gravity.reset();
  const Journey braking(200.0, [](double t) { return 0.3 * std::clamp(std::min(t - 1.5, 3.5 - t) / 0.5, 0.0, 1.0); });
  block.options.reading.rest = std::array{0.0, 1.4}; // with vibration of 0.1 g
  block.check_decided(braking.csv());
  block.options.reading.rest = std::array{0.0, 3.9};
  block.check_open(braking.csv(), Evidence::unit);
}
