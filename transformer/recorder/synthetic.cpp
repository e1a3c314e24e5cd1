#include "transformer/recorder/synthetic.h"

#include "transformer/recorder/time_text.h"

#include "mbd/base/portable_math.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

namespace steplap {

namespace {

constexpr std::int64_t k_start_ns = 1'451'903'114 * k_second_ns; // start time: 2016-01-04 10:25:14

// Returns a uniform pseudo-random number in −1 … 1 for a counter (SplitMix64).
double noise(std::uint64_t number) {
  std::uint64_t x = number * 0x9E3779B97F4A7C15U + 0x9E3779B97F4A7C15U;
  x = (x ^ x >> 30U) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27U) * 0x94D049BB133111EBU;
  return static_cast<double>((x ^ x >> 31U) >> 11U) * 0x1p-52 - 1.0;
}

double half_sine(double t, double begin, double length, double peak) {
  return t < begin || t > begin + length ? 0.0 : peak * portable::sin(std::numbers::pi * (t - begin) / length);
}

// Returns the acceleration of the example record, in g.
std::array<double, 3> acceleration(double t, std::uint64_t sample) {
  const double x = half_sine(t, 3.0, 0.05, 3.1) + half_sine(t, 6.5, 0.12, 1.6);
  return {x + 0.01 * noise(3 * sample), 0.1 * x + 0.01 * noise(3 * sample + 1), 1.0 + 0.01 * noise(3 * sample + 2)};
}

template <class... Values> std::string printed(const char* format, Values... values) {
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

long counts(double g, double per_g) { return std::lround(g * per_g); }

std::string with_comma(std::string text) {
  for (char& c : text)
    if (c == '.') c = ',';
  return text;
}

/// Writes ten seconds of rows at a given rate, Hz; `row` returns the line of one sample.
template <class Row> void add_rows(std::string& text, double rate, Row row) {
  for (int i = 0; i < static_cast<int>(10.0 * rate); ++i) text += row(i, i / rate, acceleration(i / rate, static_cast<std::uint64_t>(i)));
}

std::string gcdc() {
  std::string text = ";Title, http://www.gcdataconcepts.com, X16-1C, Analog Dev ADXL345\n;Version, 1113, Build date, Jan 1 "
                     "2016\n;Start_time, 2016-01-04, 10:25:14.000\n"
                     ";Temperature, -999.00, deg C, Vbat, 1415, mv\n;SampleRate, 400,Hz\n;Deadband, 0, counts\n;DeadbandTimeout, "
                     "0,sec\n;Headers, time,Ax,Ay,Az\n";
  add_rows(text, 400.0, [](int, double t, const auto& a) {
    return printed("%.4f,%ld,%ld,%ld\n", t, counts(a[0], 2048), counts(a[1], 2048), counts(a[2], 2048));
  });
  return text + ";stopped, by button\n";
}

std::string gcdc_epoch() {
  std::string text = ";Title, http://www.gcdataconcepts.com, HAM-IMU, 2.0\n;Start_time, 2016-01-04, 10:25:14.000\n;Accel, 225, 1000, 16, "
                     "g\n;Time, Ax, Ay, Az, T\n";
  add_rows(text, 225.0, [](int i, double t, const auto& a) {
    std::string row = printed("%.6f,%ld,%ld,%ld", 1451903114.0 + t, counts(a[0], 1000), counts(a[1], 1000), counts(a[2], 1000));
    return row + (i % 225 == 0 ? printed(",%.1f\n", 21.5) : std::string("\n"));
  });
  return text;
}

std::string phone() {
  std::string text = "DateTime;Magnitude;X [g];Y [g];Z [g]\r\n";
  add_rows(text, 100.0, [](int i, double, const auto& a) {
    // Time of day: the record lies within one day.
    const std::string stamp = stamp_text(k_start_ns + std::int64_t{i} * 10'000'000).substr(11, 12);
    const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    return "04.01.2016 " + with_comma(stamp + printed(";%.4f;%.4f;%.4f;%.4f\r\n", size, a[0], a[1], a[2]));
  });
  return text;
}

// Returns a file as exported from a PALT recorder: times in days of a spreadsheet, rows equal to the previous one left out.
std::string palt() {
  std::string text = "PALT export\nDate,Sample,X [g],Y [g],Z [g]\n", last;
  add_rows(text, 128.0, [&last](int i, double t, const auto& a) -> std::string {
    const std::string values = printed(",%.1f,%.1f,%.1f\n", a[0], a[1], a[2]);
    if (values == last && i + 1 < 1280) return "";
    last = values;
    return printed("%.12f,%d", 42373.434189814814 + t / 86400.0, i + 1) + values;
  });
  return text;
}

std::string shocklog() {
  return "ShockLog 298 summary\nDate/Time,X Peak (g),Y Peak (g),Z Peak (g),Duration (ms),Velocity change (m/s)\n"
         "2016-01-04 10:25:17,3.10,0.31,1.02,50,0.97\n2016-01-04 10:25:20,1.60,0.16,1.01,120,1.20\n";
}

std::string monilog() {
  return "MONILOG events\nTimestamp;Max [g];Strength [m/s];Duration [ms]\n04.01.2016 10:25:17;3,12;0,970;50\n04.01.2016 "
         "10:25:20;1,61;1,198;120\n";
}

std::string msr() {
  std::string text = "*CREATOR\nMSR145\n*STARTTIME\n2016-01-04;10:25:14\n*MODUL\n*NAME\n*DATA\nTIME;ACC x;ACC y;ACC z\n;g;g;g\n";
  add_rows(text, 50.0, [](int i, double, const auto& a) {
    return stamp_text(k_start_ns + std::int64_t{i} * 20'000'000) + printed(";%.3f;%.3f;%.3f\n", a[0], a[1], a[2]);
  });
  return text;
}

std::string lansmont() {
  std::string text = "Lansmont SaverXware export\nSample rate: 1000 Hz\n\nTime (ms)\tX (g)\tY (g)\tZ (g)\n";
  add_rows(text, 1000.0, [](int, double t, const auto& a) { return printed("%.0f\t%.3f\t%.3f\t%.3f\n", t * 1e3, a[0], a[1], a[2]); });
  return text;
}

std::string solve() {
  std::string text = "# SOLVE g-log vibra\n# rate = 200 Hz\nt[s] x[m/s^2] y[m/s^2] z[m/s^2]\n";
  add_rows(text, 200.0, [](int, double t, const auto& a) {
    return printed("%.3f %.3f %.3f %.3f\n", t, a[0] * 9.80665, a[1] * 9.80665, a[2] * 9.80665);
  });
  return text;
}

std::string endaq() {
  std::string text =
      "# enDAQ export\n# Recording: 2016-01-04\n\"Time (s)\",\"X Acceleration (g)\",\"Y Acceleration (g)\",\"Z Acceleration (g)\"\n";
  add_rows(text, 2000.0, [](int, double t, const auto& a) { return printed("%.6f,%.5f,%.5f,%.5f\n", t, a[0], a[1], a[2]); });
  return text;
}

struct RecordMaker {
  RecordKind kind;
  std::string (*make)();
};
const std::vector<RecordMaker>& makers() {
  static const std::vector<RecordMaker> list = {
      {{"gcdc", "Gulf Coast Data Concepts: counts whose scale is not said (2048 are 1 g)"}, gcdc},
      {{"gcdc-epoch", "the same, later models: seconds since 1970, scale in the header, ragged rows"}, gcdc_epoch},
      {{"phone", "phone logger: semicolons, decimal comma, local dates"}, phone},
      {{"palt", "PALT: days of a spreadsheet, repeated samples left out"}, palt},
      {{"shocklog", "ShockLog summary: peaks without waveforms"}, shocklog},
      {{"monilog", "MONILOG list: magnitude, strength, duration"}, monilog},
      {{"msr", "MSR: blocks, a line of units"}, msr},
      {{"lansmont", "Lansmont: tabs, milliseconds"}, lansmont},
      {{"solve", "SOLVE: blanks, comments with #"}, solve},
      {{"endaq", "enDAQ: quoted names, comments with #"}, endaq}};
  return list;
}

} // namespace

const std::vector<RecordKind>& record_kinds() {
  static const std::vector<RecordKind> kinds = [] {
    std::vector<RecordKind> list;
    for (const RecordMaker& maker : makers()) list.push_back(maker.kind);
    return list;
  }();
  return kinds;
}

std::string make_record(const std::string& kind) {
  for (const RecordMaker& maker : makers())
    if (maker.kind.name == kind) return maker.make();
  return "";
}

} // namespace steplap
