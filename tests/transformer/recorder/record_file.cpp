#include "record_file.h"

#include "transformer/recorder/fields.h"
#include "transformer/recorder/time_text.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace steplap::test {

namespace {

constexpr std::size_t k_rows = 40, k_trap_row = 20, k_missing_axis = 1;
constexpr double k_step = 0.01;                                  // s
constexpr std::int64_t k_start_ns = 1'451'903'114 * k_second_ns; // 2016-01-04 10:25:14
constexpr double k_start_days = 42373.434189814814;              // the same

template <class... Values> std::string printed(const char* format, Values... values) {
  std::array<char, 100> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

double factor_of(Scale scale) {
  switch (scale) {
  case Scale::g: return k_gravity;
  case Scale::mg: return k_gravity / 1000.0;
  case Scale::si: return 1.0;
  default: return k_gravity / 2048.0;
  }
}

const char* unit_of(Scale scale) {
  switch (scale) {
  case Scale::g: return "g";
  case Scale::mg: return "mG";
  case Scale::si: return "m/s^2";
  default: return "counts";
  }
}

bool is_counts(Scale scale) { return scale == Scale::counts_with_scale || scale == Scale::counts_alone; }
bool is_number(Clock clock) {
  return clock == Clock::seconds || clock == Clock::milliseconds || clock == Clock::epoch || clock == Clock::days;
}

std::string utf16(const std::string& text, bool is_big, bool is_marked) {
  std::string wide = !is_marked ? "" : is_big ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) {
    if (is_big) wide += '\0';
    wide += c;
    if (!is_big) wide += '\0';
  }
  return wide;
}

// One row: times in steps from the start, so that gaps and steps back can be written.
struct Row {
  double steps = 0.0;
  std::array<std::string, 3> fields;
  std::array<double, 3> a{};
  bool is_missing = false;
};

class Maker {
public:
  Maker(const Manner& manner, std::uint32_t seed) : manner_(manner), random_(seed) {}

  MadeFile make() {
    header();
    rows();
    finish();
    expect();
    return std::move(made_);
  }

private:
  void line(const std::string& text) {
    made_.text += text + manner_.line_end;
    ++lines_;
  }
  std::string decimal(std::string number) const {
    if (manner_.decimal == ',') std::replace(number.begin(), number.end(), '.', ',');
    return number;
  }
  void leave_open(const std::string& option, std::function<void(ReadOptions&)> settle, std::size_t at = 0) {
    made_.open.push_back({option, at, std::move(settle)});
  }

  void header() {
    const std::string mark = manner_.comment ? std::string(1, manner_.comment) : "";
    if (manner_.comment) line(mark + " made for a test");
    if (manner_.has_rate) line(mark + "SampleRate: 100 Hz");
    if (manner_.scale == Scale::counts_with_scale) line(mark + "Accel, 100, 2048, 16, g");
    if (manner_.unit_place == UnitPlace::header) line(mark + "Units: " + unit_of(manner_.scale));
    names();
  }

  void names() {
    const bool in_names = manner_.unit_place == UnitPlace::names;
    std::vector<std::string> names, units;
    if (manner_.clock != Clock::none) {
      const std::string unit = !manner_.says_clock_unit || !is_number(manner_.clock) ? ""
                               : manner_.clock == Clock::milliseconds                ? "ms"
                               : manner_.clock == Clock::days                        ? "days"
                                                                                     : "s";
      names.push_back("Time" + (in_names && !unit.empty() ? "[" + unit + "]" : ""));
      units.push_back(unit.empty() && manner_.delimiter == ' ' ? "-" : unit);
    }
    for (const char* axis : {"Ax", "Ay", "Az"}) {
      names.push_back(axis + (in_names ? "[" + std::string(unit_of(manner_.scale)) + "]" : ""));
      units.push_back(unit_of(manner_.scale));
    }
    if (manner_.is_ragged) names.push_back("T"), units.push_back("degC");
    if (manner_.has_names) line((manner_.are_names_comment ? std::string(1, manner_.comment) : "") + joined(names));
    names_ = joined(names);
    if (manner_.unit_place == UnitPlace::line) line(joined(units));
  }

  std::string joined(const std::vector<std::string>& fields) const {
    std::string text;
    for (const std::string& field : fields)
      text += (text.empty() && &field == &fields.front() ? "" : std::string(1, manner_.delimiter)) + field;
    return text;
  }

  std::string time_text(double steps) const {
    const double t = steps * k_step;
    const std::int64_t ns = k_start_ns + std::llround(t * 1e3) * 1'000'000;
    const std::string stamp = stamp_text(ns), clock = decimal(stamp.substr(11)), year = stamp.substr(0, 4), month = stamp.substr(5, 2),
                      day = stamp.substr(8, 2);
    switch (manner_.clock) {
    case Clock::seconds: return decimal(printed("%.3f", t));
    case Clock::milliseconds: return printed("%.0f", t * 1e3);
    case Clock::iso: return stamp.substr(0, 10) + "T" + clock;
    case Clock::local_dots: return day + "." + month + "." + year + " " + clock;
    case Clock::local_slashes: return day + "/" + month + "/" + year + " " + clock;
    case Clock::epoch: return decimal(printed("%.6f", 1451903114.0 + t));
    case Clock::days: return decimal(printed("%.11f", k_start_days + t / 86400.0));
    case Clock::none: break;
    }
    return "";
  }

  Row random_row(double steps) {
    Row row;
    row.steps = steps;
    for (std::size_t i = 0; i < 3; ++i) {
      std::uniform_real_distribution<double> size(-1.5, 1.5);
      const double g = size(random_);
      row.fields[i] =
          is_counts(manner_.scale) ? printed("%ld", std::lround(g * 2048.0)) : printed("%.4f", g * k_gravity / factor_of(manner_.scale));
      row.a[i] = std::stod(row.fields[i]) * factor_of(manner_.scale);
    }
    return row;
  }

  void rows() {
    double steps = 0.0;
    for (std::size_t i = 0; i < k_rows; ++i, steps += 1.0) {
      if (i == k_trap_row && manner_.trap == RowTrap::gap) steps += 10.0;
      Row row = random_row(steps);
      if (i == k_trap_row && manner_.trap == RowTrap::repeated) row.steps -= 1.0;
      if (i == k_trap_row && manner_.trap == RowTrap::backward) row.steps -= 1.4;
      if (i >= k_trap_row && i < k_trap_row + 5 && manner_.trap == RowTrap::clipped) {
        row.fields[0] = is_counts(manner_.scale) ? "32767" : printed("%.4f", 16.0 * k_gravity / factor_of(manner_.scale));
        row.a[0] = std::stod(row.fields[0]) * factor_of(manner_.scale);
      }
      if (i == k_trap_row && manner_.trap == RowTrap::missing) {
        row.fields[k_missing_axis] = manner_.variant % 2 == 0 || manner_.delimiter == ' ' ? "NaN" : "";
        row.is_missing = true;
      }
      if (i == k_trap_row && manner_.trap == RowTrap::comment) line("# battery changed");
      if (i == k_trap_row && manner_.trap == RowTrap::block) line(names_);
      if (i == k_trap_row) trap_line_ = lines_ + 1;
      write(row, i);
      rows_.push_back(row);
    }
  }

  void write(const Row& row, std::size_t i) {
    std::string text;
    const auto put = [&](const std::string& field) {
      const bool may_be_left_out =
          i == k_trap_row && (manner_.trap == RowTrap::missing || manner_.trap == RowTrap::repeated || manner_.trap == RowTrap::backward);
      if (!may_be_left_out) made_.values.push_back({made_.text.size() + text.size(), field.size()});
      text += field;
    };
    if (manner_.clock != Clock::none) {
      put(time_text(row.steps));
      text += manner_.delimiter;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0) text += manner_.delimiter;
      put(decimal(row.fields[k]));
    }
    if (manner_.is_ragged && i % 7 == 2) text += manner_.delimiter + decimal("21.5");
    line(text);
  }

  void leave_last_row_out() {
    rows_.pop_back();
    made_.values.resize(made_.values.size() - (manner_.clock == Clock::none ? 3 : 4));
  }

  void finish() {
    made_.last_line = lines_;
    if (manner_.ending == Ending::no_line_break) {
      made_.text.resize(made_.text.size() - manner_.line_end.size());
      const bool has_more = manner_.is_ragged && (k_rows - 1) % 7 == 2; // a field that is not read: the last axis is whole
      if (is_counts(manner_.scale) && !has_more) leave_last_row_out();  // its number may lack digits
    }
    if (manner_.ending == Ending::cut_row) { // in the middle of the axis before the last
      const auto place = made_.text.rfind(manner_.delimiter);
      made_.text.resize(place - 2);
      leave_last_row_out();
    }
    if (manner_.ending == Ending::comment) line("# stopped by button");
    if (manner_.encoding == Encoding::marked_utf8) made_.text.insert(0, "\xEF\xBB\xBF");
    if (manner_.encoding == Encoding::utf16_little || manner_.encoding == Encoding::utf16_unmarked)
      made_.text = utf16(made_.text, false, manner_.encoding == Encoding::utf16_little);
    if (manner_.encoding == Encoding::utf16_big) made_.text = utf16(made_.text, true, true);
  }

  // What the file does not say, and what has to come of it.
  void expect() {
    if (manner_.delimiter == ',' && manner_.decimal == ',') leave_open("--decimal", [](ReadOptions& o) { o.decimal = ','; });
    if (!manner_.has_names && (manner_.clock == Clock::none || is_number(manner_.clock))) {
      const bool has_time = manner_.clock != Clock::none;
      leave_open("--time", [has_time](ReadOptions& o) { o.time = has_time ? "1" : "none"; });
    }
    if (manner_.clock == Clock::local_slashes) leave_open("--dates", [](ReadOptions& o) { o.dates = k_day_first; });
    if (is_number(manner_.clock) && !says_time_unit()) {
      const char* unit = manner_.clock == Clock::seconds        ? "s"
                         : manner_.clock == Clock::milliseconds ? "ms"
                         : manner_.clock == Clock::epoch        ? "epoch"
                                                                : "days";
      leave_open("--time-unit", [unit](ReadOptions& o) { o.time_unit = unit; });
    }
    if (manner_.clock == Clock::none && !manner_.has_rate) leave_open("--rate", [](ReadOptions& o) { o.rate = 100.0; });
    const bool says_unit = manner_.unit_place != UnitPlace::nowhere && !(manner_.unit_place == UnitPlace::names && !manner_.has_names);
    if (manner_.scale == Scale::counts_alone) leave_open("--counts-per-g", [](ReadOptions& o) { o.counts_per_g = 2048.0; });
    else if (!says_unit && manner_.scale != Scale::counts_with_scale)
      leave_open("--unit", [unit = unit_of(manner_.scale)](ReadOptions& o) { o.unit = unit; });
    expect_rows();
    made_.time_error = manner_.clock == Clock::days ? 1e-6 : manner_.clock == Clock::epoch ? 5e-7 : 1e-12;
  }

  bool says_time_unit() const {
    if (manner_.has_rate && (manner_.clock == Clock::seconds || manner_.clock == Clock::milliseconds || manner_.clock == Clock::epoch))
      return true; // 100 Hz fit one unit only
    return manner_.says_clock_unit &&
           ((manner_.unit_place == UnitPlace::names && manner_.has_names) || manner_.unit_place == UnitPlace::line);
  }

  void expect_rows() {
    const bool splits = manner_.variant % 2 == 0, has_times = manner_.clock != Clock::none;
    made_.segments.emplace_back();
    std::size_t of_block = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      Row row = rows_[i];
      const bool is_trap = i == k_trap_row;
      if (is_trap && ((manner_.trap == RowTrap::gap && has_times) || manner_.trap == RowTrap::block ||
                      (manner_.trap == RowTrap::backward && has_times && splits))) {
        made_.segments.emplace_back();
        if (manner_.trap == RowTrap::block) of_block = 0;
      }
      const double t = has_times ? row.steps * k_step : static_cast<double>(of_block) * k_step;
      ++of_block;
      if (is_trap && has_times && (manner_.trap == RowTrap::repeated || (manner_.trap == RowTrap::backward && !splits))) continue;
      if (row.is_missing && splits) continue; // skipped
      if (row.is_missing) row.a[k_missing_axis] = rows_[i - 1].a[k_missing_axis];
      made_.segments.back().push_back({t, row.a});
    }
    if (manner_.trap == RowTrap::missing)
      leave_open(
          "--missing", [splits](ReadOptions& o) { o.missing = splits ? IfMissing::skip : IfMissing::hold; }, trap_line_);
    if (manner_.trap == RowTrap::repeated && has_times)
      leave_open(
          "--repeated", [](ReadOptions& o) { o.repeated = IfRepeated::first; }, trap_line_);
    if (manner_.trap == RowTrap::backward && has_times)
      leave_open(
          "--backward", [splits](ReadOptions& o) { o.backward = splits ? IfBackward::split : IfBackward::drop; }, trap_line_);
  }

  const Manner& manner_;
  std::mt19937 random_;
  MadeFile made_;
  std::vector<Row> rows_;
  std::string names_;
  std::size_t lines_ = 0, trap_line_ = 0;
};

} // namespace

MadeFile make_file(const Manner& manner, std::uint32_t seed) { return Maker(manner, seed).make(); }

Manner random_manner(std::mt19937& random) {
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  Manner m;
  m.delimiter = ",;\t "[below(4)];
  m.decimal = below(2) ? ',' : '.';
  m.encoding = static_cast<Encoding>(below(5));
  m.line_end = std::array<const char*, 3>{"\n", "\r\n", "\r"}[static_cast<std::size_t>(below(3))];
  m.comment = "\0#*;"[below(4)];
  m.has_rate = below(2);
  m.has_names = below(4) > 0;
  m.are_names_comment = m.has_names && m.comment && below(3) == 0;
  m.clock = static_cast<Clock>(below(8));
  m.says_clock_unit = below(2);
  m.scale = static_cast<Scale>(below(5));
  m.unit_place = static_cast<UnitPlace>(below(4));
  m.trap = static_cast<RowTrap>(below(8));
  m.ending = static_cast<Ending>(below(4));
  m.is_ragged = m.has_names && below(4) == 0;
  m.variant = below(4);
  // What no file can have together.
  if (m.delimiter == ';' && m.comment == ';') m.comment = '#';
  if (m.delimiter == ' ' && (m.clock == Clock::local_dots || m.clock == Clock::local_slashes)) m.clock = Clock::iso;
  if (m.delimiter == ',' && m.decimal == ',') { // whole numbers, stamps and rows of several lengths do not come in pairs
    m.decimal = '.';
    if (!is_counts(m.scale) && (m.clock == Clock::seconds || m.clock == Clock::none) && m.trap != RowTrap::missing && !m.is_ragged &&
        m.ending != Ending::cut_row)
      m.decimal = ',';
  }
  if (is_counts(m.scale) && m.unit_place != UnitPlace::nowhere) m.unit_place = UnitPlace::names;
  if (is_counts(m.scale)) m.has_names = true;
  if (m.clock == Clock::epoch && m.says_clock_unit) m.has_rate = false;
  if (m.are_names_comment && m.unit_place == UnitPlace::line) m.unit_place = UnitPlace::names;
  if (!m.has_names && m.unit_place == UnitPlace::line) m.unit_place = UnitPlace::nowhere;
  if (!m.has_names && m.trap == RowTrap::block) m.trap = RowTrap::none;
  return m;
}

std::string text_of(const Manner& m) {
  return "delimiter '" + std::string(1, m.delimiter) + "' decimal '" + m.decimal + "' encoding " +
         std::to_string(static_cast<int>(m.encoding)) + " line end " + std::to_string(m.line_end.size()) +
         (m.line_end[0] == '\r' ? "r" : "n") + " comment '" + (m.comment ? std::string(1, m.comment) : "") + "' names " +
         std::to_string(m.has_names) + std::to_string(m.are_names_comment) + " rate " + std::to_string(m.has_rate) + " ragged " +
         std::to_string(m.is_ragged) + " clock " + std::to_string(static_cast<int>(m.clock)) + " unit said " +
         std::to_string(m.says_clock_unit) + " scale " + std::to_string(static_cast<int>(m.scale)) + " unit place " +
         std::to_string(static_cast<int>(m.unit_place)) + " trap " + std::to_string(static_cast<int>(m.trap)) + " ending " +
         std::to_string(static_cast<int>(m.ending)) + " variant " + std::to_string(m.variant);
}

ReadResult read_text(const std::string& text, const ReadOptions& options) {
  LineSource source(text, "record.csv");
  Keep keep;
  ReadResult result{read_record(source, options, keep), {}};
  result.segments = std::move(keep.segments);
  return result;
}

std::string refusal(const std::string& text, const ReadOptions& options, std::size_t line) {
  try {
    static_cast<void>(read_text(text, options));
  } catch (const RecordError& error) {
    const std::string place = "record.csv:" + std::to_string(error.line()) + ":" + std::to_string(error.column()) + ": ";
    CHECK(error.line() > 0);
    CHECK(error.column() > 0);
    CHECK(std::string(error.what()).starts_with(place));
    if (line > 0) CHECK_MESSAGE(error.line() == line, error.what());
    return error.what();
  }
  FAIL("read, where it had to be refused");
  return "";
}

bool names_option(const std::string& message, const std::string& option) {
  for (auto at = message.find(option); at != std::string::npos; at = message.find(option, at + 1)) {
    const char next = at + option.size() < message.size() ? message[at + option.size()] : ' ';
    if (next != '-' && !(next >= 'a' && next <= 'z')) return true;
  }
  return false;
}

ReadResult read_and_answer(const MadeFile& made, ReadOptions& options) {
  std::vector<Open> open = made.open;
  for (;;) {
    if (open.empty()) return read_text(made.text, options);
    const std::string message = refusal(made.text, options, 0);
    const auto asked = std::find_if(open.begin(), open.end(), [&](const Open& each) { return names_option(message, each.option); });
    if (asked == open.end()) FAIL(message);
    if (asked->line > 0) CHECK_MESSAGE(message.starts_with("record.csv:" + std::to_string(asked->line) + ":"), message);
    asked->settle(options);
    open.erase(asked);
  }
}

void check_same(const Segments& read, const Segments& written, double time_error) {
  REQUIRE(read.size() == written.size());
  for (std::size_t s = 0; s < read.size(); ++s) {
    REQUIRE(read[s].size() == written[s].size());
    for (std::size_t i = 0; i < read[s].size(); ++i) {
      const Sample &a = read[s][i], &b = written[s][i];
      if (!(std::abs(a.t - b.t) <= time_error)) FAIL("segment " << s << " row " << i << ": time " << a.t << " instead of " << b.t);
      for (std::size_t k = 0; k < 3; ++k) // a number times a factor, rounded in another order: a few units of the last place
        if (!(std::abs(a.a[k] - b.a[k]) <= 1e-15 * std::abs(b.a[k])))
          FAIL("segment " << s << " row " << i << " axis " << k << ": " << a.a[k] << " instead of " << b.a[k]);
    }
  }
}

} // namespace steplap::test
