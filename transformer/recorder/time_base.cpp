// Determines the time base of a record: column, format, unit and sampling rate.
#include "transformer/recorder/fields.h"
#include "transformer/recorder/layout.h"
#include "transformer/recorder/record_error.h"
#include "transformer/recorder/time_text.h"

#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace steplap {

namespace {

constexpr double k_year_2200 = 7.258e9;   // latest time, s since 1970; until then nanoseconds fit into 64 bits
constexpr std::size_t k_most_rows = 4000; // number of rows of the head that are examined

/// Fields of one column in the first rows.
struct ColumnHead {
  std::vector<std::string> texts;
  std::vector<std::size_t> lines, columns; ///< lines and columns of the fields in the file
};

ColumnHead head_of_column(const std::vector<HeaderLine>& head, const TableShape& shape, std::size_t column) {
  ColumnHead result;
  std::vector<std::string_view> fields;
  for (std::size_t i = shape.first_data; i < head.size() && result.texts.size() < k_most_rows; ++i) {
    if (is_comment(head[i].text, shape.delimiter) || !shape.split(head[i].text, fields) || !looks_like_row(fields) ||
        column >= fields.size())
      continue;
    result.texts.emplace_back(fields[column]);
    result.lines.push_back(head[i].number);
    result.columns.push_back(static_cast<std::size_t>(fields[column].data() - head[i].text.data()) + 1);
  }
  return result;
}

class TimeFinder {
public:
  TimeFinder(const RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata, const ReadOptions& options,
             std::vector<std::string>& notes)
      : layout_(layout), shape_(layout.shape), head_(head), options_(options), notes_(notes), header_rate_(rate_of(metadata)),
        metadata_(metadata) {}

  TimeBase find() {
    choose_columns();
    if (has_time_) {
      read_head();
      if (!parse_number(first_.texts.front(), shape_.decimal)) settle_stamps();
      else settle_numbers();
    } else {
      base_.text = "no column of times: rows are equally spaced";
    }
    find_start();
    if (!layout_.is_peaks) find_rate();
    return base_;
  }

private:
  [[noreturn]] void fail(std::size_t row, const std::string& what) const {
    throw RecordError(layout_.file, first_.lines.empty() ? 0 : first_.lines[row], first_.lines.empty() ? 0 : first_.columns[row], what);
  }

  std::optional<std::size_t> named(Role role) const {
    std::optional<std::size_t> best;
    int weight = 0;
    for (std::size_t i = 0; i < shape_.names.size(); ++i) {
      const NamedRole each = role_of(heading_of(shape_.names[i]).name);
      if (each.role == role && each.weight > weight) best = i, weight = each.weight;
    }
    return best;
  }

  void choose_columns() {
    base_.index_column = named(Role::index);
    if (options_.time == "none") return;
    if (options_.time) {
      base_.column = column_of(shape_, *options_.time, "--time", layout_.file);
      has_time_ = true;
    } else if (shape_.names.empty()) { // without names: a date in the first column is the time
      has_time_ = std::none_of(layout_.axes.begin(), layout_.axes.end(), [](const AxisColumn& axis) { return axis.column == 0; });
      const ColumnHead first = head_of_column(head_, shape_, 0);
      if (has_time_ && !first.texts.empty() && parse_number(first.texts.front(), shape_.decimal))
        throw RecordError(layout_.file, first.lines.front(), first.columns.front(),
                          "No line states what the first column is. Give --time 1 if it holds times, or --time none.");
    } else {
      const auto time = named(Role::time), date = named(Role::date);
      has_time_ = time || date;
      if (has_time_) base_.column = time ? *time : *date;
      if (time && date) pair_date_and_clock(*date, *time);
    }
  }

  void pair_date_and_clock(std::size_t date, std::size_t time) {
    const ColumnHead clocks = head_of_column(head_, shape_, time);
    if (clocks.texts.empty()) return;
    const auto clock = parse_stamp(clocks.texts.front(), k_year_first);
    if (!clock || clock->has_date) return;
    base_.kind = TimeKind::date_and_clock;
    base_.column = date;
    base_.clock_column = time;
  }

  void read_head() {
    first_ = head_of_column(head_, shape_, base_.column);
    if (base_.kind == TimeKind::date_and_clock) clocks_ = head_of_column(head_, shape_, base_.clock_column);
    if (first_.texts.empty())
      throw RecordError(layout_.file, head_[shape_.first_data].number, 1,
                        "The first rows have no field in the column of times. Choose another with --time, or --time none.");
  }

  void settle_stamps() {
    if (base_.kind != TimeKind::date_and_clock) base_.kind = TimeKind::stamp;
    unsigned possible = k_year_first | k_day_first | k_month_first;
    bool has_dates = false;
    for (std::size_t i = 0; i < first_.texts.size(); ++i) {
      const unsigned orders = possible_date_orders(first_.texts[i]);
      if (orders == 0 && parse_stamp(first_.texts[i], k_year_first)) continue; // a time of day fits every order
      if (orders == 0)
        fail(i, "'" + shown(first_.texts[i]) +
                    "' is neither a number nor a date or time that is understood. Write times as 2016-01-31 12:00:00.000, or choose "
                    "another column with --time.");
      has_dates = true;
      possible &= orders;
      if (possible == 0)
        fail(i, "'" + shown(first_.texts[i]) + "' does not fit the order of day, month and year of the rows before. Correct it.");
    }
    if (options_.dates && has_dates) {
      if (!(possible & *options_.dates))
        fail(0, "'" + shown(first_.texts.front()) + "' is no date in the order given by --dates. Give another order.");
      possible = *options_.dates;
    }
    if (has_dates && std::popcount(possible) > 1)
      fail(0, "'" + shown(first_.texts.front()) +
                  "' can be read in several orders of day, month and year. Give --dates day-first, month-first or year-first.");
    base_.date_order = possible;
    const char* order = possible == k_day_first ? ", day before month" : possible == k_month_first ? ", month before day" : "";
    base_.text = std::string(base_.kind == TimeKind::date_and_clock ? "date and time of day"
                             : has_dates                            ? "date and time"
                                                                    : "time of day without a date") +
                 (has_dates ? order : "") + " in " + column_text();
    const auto stamp = parse_stamp(first_.texts.front(), base_.date_order);
    if (stamp && has_dates) base_.start = stamp_text(first_ns(0).value_or(stamp->ns)) + (stamp->has_zone ? " UTC" : "");
  }

  std::optional<std::int64_t> first_ns(std::size_t row) const {
    const auto stamp = parse_stamp(first_.texts[row], base_.date_order);
    if (!stamp) return std::nullopt;
    if (base_.kind != TimeKind::date_and_clock) return stamp->ns;
    if (row >= clocks_.texts.size()) return std::nullopt;
    const auto clock = parse_stamp(clocks_.texts[row], k_year_first);
    return clock ? std::optional(stamp->ns + clock->ns) : std::nullopt;
  }

  std::string column_text() const {
    return base_.column < shape_.names.size() ? "'" + shown(heading_of(shape_.names[base_.column]).name) + "'"
                                              : "column " + std::to_string(base_.column + 1);
  }

  void settle_numbers() {
    base_.kind = TimeKind::number;
    for (const std::string& text : first_.texts)
      if (const auto value = parse_number(text, shape_.decimal)) numbers_.push_back(*value);
    std::string unit = options_.time_unit.value_or(""), source = "--time-unit";
    if (unit.empty() && base_.column < shape_.names.size())
      unit = heading_of(shape_.names[base_.column]).unit, source = "line " + std::to_string(shape_.names_line);
    if (unit.empty() && base_.column < shape_.units.size())
      unit = shape_.units[base_.column], source = "line " + std::to_string(shape_.units_line);
    if (unit.empty()) unit = unit_by_family_or_rate(source);
    settle_unit(unit, source);
  }

  // Returns a suggestion for the unit of the numbers, according to their magnitude; "" if there is none.
  std::string likely_unit() const {
    const double value = numbers_.front();
    const std::pair<double, const char*> epochs[] = {
        {1.0, "epoch"}, {1e-3, "\"epoch ms\""}, {1e-6, "\"epoch us\""}, {1e-9, "\"epoch ns\""}};
    for (const auto& [factor, unit] : epochs)
      if (value * factor > 9.4e8 && value * factor < 2.6e9)
        // Suggested for the years 1999 to 2052.
        return std::string(" Numbers of this size are often times since 1970: that is --time-unit ") + unit + ".";
    return is_size_of_days() ? " Numbers of this size are often the days of a spreadsheet: that is --time-unit days." : "";
  }
  // Corresponds to the years 1954 to 2119.
  bool is_size_of_days() const { return numbers_.front() > 20000.0 && numbers_.front() < 80000.0; }

  // Returns the unit that the recorder's family uses, or the unit for which the times agree with the sampling rate in the header.
  std::string unit_by_family_or_rate(std::string& source) const {
    source = "the family of the recorder";
    if (layout_.family == "Gulf Coast Data Concepts") return "s";
    if (layout_.family == "PALT" && is_size_of_days()) return "days";
    const auto rate = options_.rate ? options_.rate : header_rate_ ? std::optional(header_rate_->hz) : std::nullopt;
    if (rate && !layout_.holds)
      for (const char* unit : {"s", "ms", "us"}) {
        const double samples = typical_step() * time_unit(unit).value() * *rate;
        source = options_.rate ? "--rate" : "the rate in line " + std::to_string(header_rate_->line);
        if (samples > 0.8 && samples < 1.25) return unit;
      }
    fail(0, "Nothing says in which unit the times are. Give --time-unit s, ms, us, epoch or days." + likely_unit());
  }

  void settle_unit(const std::string& unit, const std::string& source) {
    const bool is_epoch = unit.starts_with("epoch"), is_days = unit == "days" && numbers_.front() > 20000.0;
    const auto factor = is_epoch ? (unit == "epoch" ? std::optional(1.0) : time_unit(unit.substr(6))) : time_unit(unit);
    if (!factor)
      fail(0, "'" + shown(unit) + "' (" + source +
                  ") is no unit of time. Give --time-unit s, ms, us, epoch or days, or another column with --time.");
    base_.factor = *factor;
    base_.is_relative = is_epoch || is_days || numbers_.front() * *factor > 9.4e8;
    const double since_1970 = is_days ? (numbers_.front() - 25569.0) * 86400.0 : numbers_.front() * *factor;
    if (base_.is_relative && !(std::abs(since_1970) < k_year_2200))
      fail(0, "'" + shown(first_.texts.front()) + "' as " + (is_days ? "days of a spreadsheet" : "time since 1970") +
                  " is beyond the year 2200. Correct it, or give another --time-unit.");
    const std::string what = is_epoch || (base_.is_relative && !is_days) ? "time since 1970 in " + std::string(unit == "epoch" ? "s"
                                                                                                               : is_epoch ? unit.substr(6)
                                                                                                                          : unit)
                             : is_days                                   ? "days of a spreadsheet"
                                                                         : shown(unit);
    base_.text = what + " in " + column_text() + ", by " + source;
    if (is_days) base_.start = stamp_text(static_cast<std::int64_t>(std::llround(since_1970 * 1e3)) * 1'000'000);
    else if (base_.is_relative) base_.start = stamp_text(static_cast<std::int64_t>(std::llround(since_1970 * 1e6)) * 1000) + " UTC";
  }

  // Returns the median of the forward steps of the first times, in the unit of the numbers.
  double typical_step() const {
    std::vector<double> steps;
    for (std::size_t i = 1; i < numbers_.size(); ++i)
      if (numbers_[i] > numbers_[i - 1]) steps.push_back(numbers_[i] - numbers_[i - 1]);
    if (steps.empty()) return 0.0;
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    return steps[steps.size() / 2];
  }

  void find_start() {
    if (!base_.start.empty()) return;
    if (const auto* said = metadata_.find({"starttime", "start", "starttimestamp", "recordingstart", "datetime"})) {
      std::string text;
      for (const std::string& value : said->values) text += (text.empty() ? "" : " ") + value;
      base_.start = shown(text) + " (line " + std::to_string(said->line) + ")";
    }
  }

  std::vector<double> head_times() const {
    std::vector<double> times;
    if (base_.kind == TimeKind::number)
      for (const double value : numbers_) times.push_back((value - (base_.is_relative ? numbers_.front() : 0.0)) * base_.factor);
    else
      for (std::size_t i = 0; i < first_.texts.size(); ++i)
        if (const auto ns = first_ns(i)) times.push_back(1e-9 * static_cast<double>(*ns - first_ns(0).value_or(0)));
    return times;
  }

  void find_rate() {
    const double by_times = has_time_ ? rate_by_times().value_or(0.0) : 0.0; // rate from the times, Hz; 0: unknown
    if (options_.rate) {
      base_.rate = *options_.rate;
      base_.rate_text = "--rate";
    } else if (header_rate_ && (by_times == 0.0 || layout_.holds || std::abs(by_times / header_rate_->hz - 1.0) < 0.02)) {
      base_.rate = header_rate_->hz;
      base_.rate_text = "line " + std::to_string(header_rate_->line);
    } else if (by_times > 0.0 && (!layout_.holds || base_.index_column)) {
      base_.rate = by_times;
      base_.rate_text = "the first " + std::to_string(first_.texts.size()) + " times";
      if (header_rate_)
        notes_.push_back("Line " + std::to_string(header_rate_->line) + " says " + rounded_text(header_rate_->hz) +
                         " Hz, but the times say " + rounded_text(by_times) + " Hz: the times are used. Give --rate if they are wrong.");
    } else {
      throw RecordError(layout_.file, head_[shape_.first_data].number, 1,
                        layout_.holds ? "Samples are left out of this record, and no line states the sampling rate. Give --rate HZ."
                                      : "The sampling rate is unknown: there is no column of times, or its first times do not rise, "
                                        "and no line gives a rate. Give --rate HZ, or --time COLUMN.");
    }
    if (!(base_.rate > 1e-6 && base_.rate < 1e8))
      throw RecordError(layout_.file, head_[shape_.first_data].number, 1,
                        "A rate of " + rounded_text(base_.rate) + " Hz (" + base_.rate_text +
                            ") is none that a recorder has. Give --rate HZ or --time-unit.");
  }

  // Returns the sampling rate, Hz, as the number of intervals without gaps divided by their total time. If the file counts samples and some
  // are missing, the counter is used. A step with missing rows counts as its length in intervals. Without such steps the mean is exact even
  // if times are rounded.
  std::optional<double> rate_by_times() const {
    const std::vector<double> times = head_times();
    std::vector<double> steps, usual;
    for (std::size_t i = 1; i < times.size(); ++i)
      if (times[i] > times[i - 1]) steps.push_back(times[i] - times[i - 1]);
    if (steps.empty()) return std::nullopt;
    usual = steps;
    std::nth_element(usual.begin(), usual.begin() + static_cast<std::ptrdiff_t>(usual.size() / 2), usual.end());
    const double median = usual[usual.size() / 2];
    if (base_.index_column)
      if (const auto rate = rate_by_index(times)) return rate;
    // Step, relative to the usual one, above which rows are missing; more frequent long steps (share k_rare) are clock jitter.
    constexpr double k_hole = 1.5, k_rare = 0.1;
    double regular = 0.0, count = 0.0, all = 0.0;
    for (const double step : steps) {
      if (step <= k_hole * median) regular += step, count += 1.0;
      if (step <= options_.gap * median) all += 1.0;
    }
    const bool has_holes = all - count <= k_rare * all && !layout_.holds;
    const double mean = regular / count;
    double sum = 0.0, intervals = 0.0;
    for (const double step : steps)
      if (step <= options_.gap * median) sum += step, intervals += has_holes && step > k_hole * median ? std::round(step / mean) : 1.0;
    return intervals / sum;
  }

  std::optional<double> rate_by_index(const std::vector<double>& times) const {
    const ColumnHead counts = head_of_column(head_, shape_, *base_.index_column);
    if (counts.texts.size() != times.size() || times.size() < 2) return std::nullopt;
    const auto first = parse_number(counts.texts.front(), '.'), last = parse_number(counts.texts.back(), '.');
    if (!first || !last || !(*last > *first) || !(times.back() > times.front())) return std::nullopt;
    return (*last - *first) / (times.back() - times.front());
  }

  const RecordLayout& layout_;
  const TableShape& shape_;
  const std::vector<HeaderLine>& head_;
  const ReadOptions& options_;
  std::vector<std::string>& notes_;
  std::optional<HeaderRate> header_rate_;
  const Metadata& metadata_;
  TimeBase base_;
  bool has_time_ = false;
  ColumnHead first_, clocks_;
  std::vector<double> numbers_;
};

} // namespace

TimeBase find_time(const RecordLayout& layout, const std::vector<HeaderLine>& head, const Metadata& metadata, const ReadOptions& options,
                   std::vector<std::string>& notes) {
  return TimeFinder(layout, head, metadata, options, notes).find();
}

} // namespace steplap
