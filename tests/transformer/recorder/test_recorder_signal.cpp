// The signal kind `recorder`: a recorder's file as the load of a model, against what the record holds, and what it refuses.
#include "transformer/recorder/fields.h"
#include "transformer/recorder/recorder_signal.h"
#include "transformer/recorder/synthetic.h"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <unistd.h>

using namespace steplap;

namespace {

using Values = std::vector<std::pair<std::string, FieldValue>>;

struct RecordOnDisk {
  std::string path;
  RecordOnDisk(const std::string& name, const std::string& text)
      : path((std::filesystem::temp_directory_path() / ("steplap_recorder_" + std::to_string(::getpid()) + "_" + name)).string()) {
    std::ofstream(path, std::ios::binary) << text;
  }
  RecordOnDisk(const RecordOnDisk&) = delete;
  RecordOnDisk& operator=(const RecordOnDisk&) = delete;
  ~RecordOnDisk() { std::filesystem::remove(path); }
};

Signal made(const RecordOnDisk& file, const Values& values) {
  const SignalKind& kind = recorder_signal_kind();
  const auto definition = kind.create();
  definition->name = "r";
  kind.fields.find("file")->set(definition.get(), file.path);
  for (const auto& [field, value] : values) kind.fields.find(field)->set(definition.get(), value);
  return kind.build(*definition);
}

std::string problem(const RecordOnDisk& file, const Values& values) {
  try {
    static_cast<void>(made(file, values));
  } catch (const ModelError& error) {
    return error.what();
  }
  return "";
}

FieldValue text(const char* value) { return std::string(value); }

// A hundred samples a second of x and y = 1 … 6 m/s², z = g.
const std::string k_plain = "time [s],x [m/s^2],y [m/s^2],z [m/s^2]\n"
                            "0.00,1,1,9.80665\n0.01,2,2,9.80665\n0.02,3,3,9.80665\n0.03,4,4,9.80665\n0.04,5,5,9.80665\n0.05,6,6,9.80665\n";

} // namespace

TEST_CASE("a record's samples are the signal's values, along an axis and along a direction") {
  const RecordOnDisk file("plain.csv", k_plain);
  const Signal x = made(file, {{"axis", text("x")}}), turned = made(file, {{"axis", text("-y")}, {"start", 0.3}, {"factor", 2.0}});
  const Signal along = made(file, {{"map", std::vector<double>{0.6, -0.8, 0.0}}});
  for (int k = 0; k < 5; ++k) {
    const double t = 0.01 * k;
    CHECK(x.value(t) == doctest::Approx(k + 1.0).epsilon(1e-12));
    CHECK(x.value(t + 0.005) == doctest::Approx(k + 1.5).epsilon(1e-12));
    CHECK(turned.value(0.3 + t + 1e-9) == doctest::Approx(-2.0 * (k + 1.0)).epsilon(1e-6));
    CHECK(along.value(t) == doctest::Approx(-0.2 * (k + 1.0)).epsilon(1e-12));
  }
  CHECK(turned.value(0.29) == 0.0);
  CHECK(x.value(0.0501) == 0.0);
  const Signal middle = made(file, {{"axis", text("x")}, {"from", 0.015}, {"to", 0.045}});
  CHECK(middle.value(0.0) == 3.0); // the first sample within the window is its begin
  CHECK(middle.value(0.0201) == 0.0);
  CHECK(made(file, {{"axis", text("z")}, {"gravity", text("z")}}).value(0.02) == 0.0);
  CHECK(made(file, {{"axis", text("z")}, {"rest", std::vector<double>{0.0, 0.03}}}).value(0.02) == doctest::Approx(0.0));
  CHECK(made(file, {{"axis", text("z")}, {"gravity", text("none")}}).value(0.02) == doctest::Approx(k_gravity));
}

// Of --make: half sines along x of 3.1 g for 50 ms at 3 s and of 1.6 g for 120 ms at 6.5 s, noise of 0.01 g; y a tenth of x.
TEST_CASE("an event of a record has its peak and its velocity, and ends at rest where that is asked for") {
  const RecordOnDisk file("endaq.csv", make_record("endaq"));
  const auto shock = [&](long event, Values more) {
    more.insert(more.end(), {{"gravity", text("z")}, {"event", event}});
    return made(file, more);
  };
  const Signal first = shock(1, {{"axis", text("x")}}), second = shock(2, {{"axis", text("x")}});
  const Signal y = shock(1, {{"axis", text("y")}});
  double peak = 0.0, peak_time = 0.0;
  for (double t = 0.0; t < 0.5; t += 1e-4)
    if (first.value(t) > peak) peak = first.value(t), peak_time = t;
  CHECK(peak == doctest::Approx(3.1 * k_gravity).epsilon(0.02)); // noise and the rate
  CHECK(std::abs(peak_time - 0.12) < 0.01);                      // the threshold of 1 g is reached 5 ms after the shock begins
  CHECK(y.value(peak_time) == doctest::Approx(0.1 * peak).epsilon(0.1));
  const double end = first.breakpoints().back();
  const double pulse = 2.0 / std::numbers::pi * 0.05 * 3.1 * k_gravity;
  CHECK(first.drive(end, DriveLevel::acceleration).rate == doctest::Approx(pulse).epsilon(0.02));
  CHECK(std::abs(shock(1, {{"axis", text("x")}, {"drift", text("line")}}).drive(end, DriveLevel::acceleration).rate) < 1e-9);
  double slow = 0.0;
  for (const double t : second.breakpoints()) slow = std::max(slow, second.value(t));
  CHECK(slow == doctest::Approx(1.6 * k_gravity).epsilon(0.02));
  // CFC 10 keeps frequencies up to 17 Hz: less of the short shock is left than of the long one.
  const Signal filtered = shock(1, {{"axis", text("x")}, {"cfc", 10.0}, {"threshold", 5.0}});
  double kept = 0.0;
  for (const double t : filtered.breakpoints()) kept = std::max(kept, filtered.value(t));
  CHECK(kept > 0.6 * peak);
  CHECK(kept < 0.95 * peak);
}

TEST_CASE("a record that is clipped or ends within an event leaves a doubt") {
  // A half-sine of 2 g, 0.1 s long, at 0.5 s, in steps of 0.01 g; clipped at 1 g; or without what follows its peak.
  const auto record = [](double most, double end) {
    std::string text = "time [s],x [g]\n";
    for (int i = 0; i <= 1000; ++i) {
      const double t = 0.001 * i, pulse = t > 0.5 && t < 0.6 ? 2.0 * std::sin(10.0 * std::numbers::pi * (t - 0.5)) : 0.01 * (i % 2);
      if (t > end) break;
      char row[64];
      std::snprintf(row, sizeof row, "%.3f,%.2f\n", t, std::min(most, pulse));
      text += row;
    }
    return text;
  };
  const auto doubts = [](const RecordOnDisk& file, double from, const Values& more = {}) {
    std::string all;
    Values values = {{"axis", text("x")}, {"from", from}};
    values.insert(values.end(), more.begin(), more.end());
    const Signal signal = made(file, values);
    for (const Signal::Doubt& doubt : signal.doubts()) all += doubt.text + ". ";
    return all;
  };
  const RecordOnDisk whole("whole.csv", record(10.0, 1.0)), clipped("clipped.csv", record(1.0, 1.0)), cut("cut.csv", record(10.0, 0.55));
  CHECK(doubts(whole, 0.0) == "");
  CHECK(doubts(clipped, 0.0).find("axis x is at 1 g") != std::string::npos);
  CHECK(doubts(clipped, 0.0, {{"cfc", 10.0}}).find("axis x is at 1 g") != std::string::npos); // a filter hides the top
  CHECK(doubts(clipped, 0.7) == "");                                                          // the window begins after the pulse
  CHECK(doubts(cut, 0.0).find("ends at 100 % of its largest value") != std::string::npos);
  CHECK(doubts(whole, 0.55).find("begins at 100 % of its largest value") != std::string::npos);
  CHECK(doubts(whole, 0.7) == ""); // 0.01 g of noise
}

TEST_CASE("what a record leaves open is asked for") {
  const RecordOnDisk plain("plain2.csv", k_plain), counts("counts.csv", make_record("gcdc")), peaks("peaks.csv", make_record("shocklog"));
  std::string parted = k_plain;
  parted += "9.00,1,1,9.80665\n9.01,1,1,9.80665\n9.02,1,1,9.80665\n";
  const RecordOnDisk gap("gap.csv", parted);
  const auto has = [](const std::string& message, const char* wanted) { return message.find(wanted) != std::string::npos; };
  CHECK(has(problem(plain, {}), "give 'axis'"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"map", std::vector<double>{1.0, 0.0, 0.0}}}), "give 'axis'"));
  CHECK(has(problem(plain, {{"map", std::vector<double>{1.0, 1.0, 0.0}}}), "length 1"));
  CHECK(has(problem(plain, {{"map", std::vector<double>{1.0, 0.0}}}), "three numbers"));
  CHECK(has(problem(plain, {{"axis", text("z")}}), "1 g at rest"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"cfc", 60.0}}), "CFC"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"event", 4L}}), "'event' is 4"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"from", 7.0}}), "no two samples"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"resample", 50.0}}), "'resample' is below"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"resample", 1e9}}), "'resample' may be at most 100 times the record's"));
  CHECK(has(problem(plain, {{"axis", text("x")}, {"sha256", text("00")}}), "SHA-256"));
  CHECK(has(problem(gap, {{"axis", text("x")}}), "2 segments"));
  CHECK(problem(gap, {{"axis", text("x")}, {"from", 8.0}}) == "");
  CHECK(has(problem(counts, {{"axis", text("x")}}), "counts_per_g"));
  CHECK(problem(counts, {{"axis", text("x")}, {"counts_per_g", 2048.0}}) == "");
  CHECK(has(problem(peaks, {{"axis", text("x")}}), "half_sine"));
}
