// The files that `steplap record --make` writes: read to the very numbers that stand in them, with the questions that each family raises.
#include "record_file.h"
#include "transformer/recorder/fields.h"
#include "transformer/recorder/synthetic.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <sstream>

using namespace steplap;
using namespace steplap::test;

namespace {

struct Family {
  std::string kind;
  char delimiter;
  std::size_t first_axis; ///< column of x, from 0; y and z follow
  double factor, rate;
  std::vector<Open> open;
};

std::vector<Family> families() {
  const double g = k_gravity;
  return {{"gcdc", ',', 1, g / 2048.0, 400.0, {{"--counts-per-g", 0, [](ReadOptions& o) { o.counts_per_g = 2048.0; }}}},
          {"gcdc-epoch", ',', 1, g / 1000.0, 225.0, {}},
          {"phone", ';', 2, g, 100.0, {}},
          {"msr", ';', 1, g, 50.0, {}},
          {"lansmont", '\t', 1, g, 1000.0, {}},
          {"solve", ' ', 1, 1.0, 200.0, {}},
          {"endaq", ',', 1, g, 2000.0, {}}};
}

// The numbers of the lines that begin with a digit and have enough fields, taken apart anew.
std::vector<std::array<double, 3>> plain_numbers(const std::string& text, const Family& family) {
  std::vector<std::array<double, 3>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream parts(line);
    for (std::string field; std::getline(parts, field, family.delimiter);) fields.push_back(field);
    if (line.empty() || line[0] < '0' || line[0] > '9' || fields.size() < family.first_axis + 3) continue;
    std::array<double, 3> row{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::string& field = fields[family.first_axis + i];
      if (const auto comma = field.find(','); comma != std::string::npos) field[comma] = '.';
      row[i] = std::stod(field) * family.factor;
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace

TEST_CASE("each family's file is read to the numbers that stand in it") {
  for (const Family& family : families()) {
    CAPTURE(family.kind);
    MadeFile made;
    made.text = make_record(family.kind);
    made.open = family.open;
    ReadOptions options;
    const ReadResult read = read_and_answer(made, options);
    const auto rows = plain_numbers(made.text, family);
    REQUIRE(rows.size() == static_cast<std::size_t>(10.0 * family.rate));
    REQUIRE(read.segments.size() == 1);
    REQUIRE(read.segments[0].size() == rows.size());
    const std::vector<Sample>& samples = read.segments[0];
    CHECK(read.recording.layout.time.rate == doctest::Approx(family.rate).epsilon(1e-4)); // times of six digits
    bool is_same = true;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      is_same &= std::abs(samples[i].t - static_cast<double>(i) / family.rate) < 1e-4; // the digits of its times
      for (std::size_t k = 0; k < 3; ++k) is_same &= std::abs(samples[i].a[k] - rows[i][k]) <= 1e-15 * std::abs(rows[i][k]);
    }
    CHECK(is_same);
    CHECK(read.recording.facts.axes[2].rest == doctest::Approx(k_gravity).epsilon(0.01)); // at rest, gravity along z; noise 0.01 g
    const double greatest =
        read.recording.facts.axes[0].greatest / k_gravity; // a sample is half a step from the peak at most; noise 0.01 g
    CHECK(greatest > 3.1 * std::cos(std::numbers::pi * 0.5 / family.rate / 0.05) - 0.02);
    CHECK(greatest < 3.12);
  }
}

TEST_CASE("samples that a recorder of the family PALT leaves out are those before them") {
  const std::string text = make_record("palt");
  const ReadResult read = read_text(text);
  CHECK(read.recording.facts.held.count > 0);
  CHECK(read.segments.size() == 1);
  CHECK(read.recording.layout.time.rate == doctest::Approx(128.0).epsilon(1e-3));
  CHECK(read.segments[0].back().t == doctest::Approx(1279.0 / 128.0).epsilon(1e-5));
}

TEST_CASE("lists of peaks are read as lists") {
  const ReadResult shocklog = read_text(make_record("shocklog"));
  REQUIRE(shocklog.recording.peaks.size() == 2);
  const PeakEntry& first = shocklog.recording.peaks[0];
  CHECK(first.axis[0] == doctest::Approx(3.1 * k_gravity).epsilon(1e-12));
  CHECK(first.duration == doctest::Approx(0.05).epsilon(1e-12));
  CHECK(first.velocity_change == doctest::Approx(0.97).epsilon(1e-12));
  CHECK(shocklog.recording.peaks[1].t == doctest::Approx(3.0).epsilon(1e-12));
  const ReadResult monilog = read_text(make_record("monilog"));
  REQUIRE(monilog.recording.peaks.size() == 2);
  CHECK(monilog.recording.peaks[1].magnitude == doctest::Approx(1.61 * k_gravity).epsilon(1e-12));
  CHECK(monilog.recording.peaks[1].velocity_change == doctest::Approx(1.198).epsilon(1e-12));
}
