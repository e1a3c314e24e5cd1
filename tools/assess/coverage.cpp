#include "tools/assess/coverage.h"

#include "mbd/base/shown_text.h"
#include "transformer/recorder/fields.h"
#include "transformer/recorder/time_text.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace steplap::assess {

namespace {

// m/s²; any road, rail or crane transport causes larger deviations from the reading at rest
constexpr double k_alive = 0.05 * k_gravity;
constexpr double k_hours = 7200.0, k_minutes = 120.0; // durations, s, above which texts use hours or minutes

std::string span_text(double seconds) {
  return seconds > k_hours     ? rounded_text(seconds / 3600.0, 4) + " h"
         : seconds > k_minutes ? rounded_text(seconds / 60.0, 4) + " min"
                               : rounded_text(seconds, 4) + " s";
}

std::string clock_text(const RecordEvents& record, double t) {
  const std::string stamp = stamp_text(*record.clock_ns + static_cast<std::int64_t>(std::llround(t * 1e9)));
  return stamp.substr(0, 19) + (record.clock_has_zone ? " UTC" : "");
}

std::optional<Stamp> instant(const std::string& text) {
  const unsigned orders = possible_date_orders(text);
  if (!std::has_single_bit(orders)) return {};
  const auto stamp = parse_stamp(text, orders);
  return stamp && stamp->has_date && stamp->has_clock ? stamp : std::nullopt;
}

MissingEvidence missing(const std::string& reason, const std::string& remedy) { return {Evidence::coverage, reason, remedy}; }

// Returns the largest deviation of an axis from its reading at rest, m/s². A tilt or an offset of the sensor causes none.
double largest_motion(const RecordEvents& record) {
  double most = 0.0;
  for (std::size_t i = 0; i < record.recording.layout.axes.size(); ++i) {
    const AxisFacts& axis = record.recording.facts.axes[i];
    most = std::max({most, axis.greatest - record.rest[i], record.rest[i] - axis.least});
  }
  return most;
}

// Returns the duration of the voyage, s.
double length_of(const Voyage& voyage) {
  return voyage.is_clock ? 1e-9 * static_cast<double>(voyage.to_ns - voyage.from_ns) : voyage.to - voyage.from;
}

// Intervals of the voyage without records: the first one, in s from the begin of the voyage, and the sum of all.
struct UncoveredTime {
  double from = 0.0, to = 0.0, sum = 0.0;
};
UncoveredTime uncovered_of(const std::vector<RecordEvents>& records, const Voyage& voyage) {
  const double length = length_of(voyage);
  std::vector<std::array<double, 2>> spans;
  for (const RecordEvents& record : records) {
    const double start = voyage.is_clock ? 1e-9 * static_cast<double>(*record.clock_ns - voyage.from_ns) : -voyage.from;
    const double slack = record.rate > 0.0 ? 1.5 / record.rate : 0.0; // a row represents the sampling interval around its time
    spans.push_back({start + record.recording.facts.first - slack, start + record.recording.facts.last + slack});
  }
  std::sort(spans.begin(), spans.end());
  UncoveredTime u;
  double reached = 0.0;
  const auto add = [&](double from, double to) {
    if (to <= from) return;
    if (u.sum == 0.0) u.from = from, u.to = to;
    u.sum += to - from;
  };
  for (const auto& [from, to] : spans) {
    add(reached, std::min(from, length));
    reached = std::max(reached, to);
  }
  add(reached, length);
  return u;
}

} // namespace

std::optional<Voyage> parse_voyage(const std::string& text) {
  const auto comma = text.find(',');
  if (comma == std::string::npos) return {};
  const std::string from(trimmed_blanks(std::string_view(text).substr(0, comma))),
      to(trimmed_blanks(std::string_view(text).substr(comma + 1)));
  Voyage v;
  v.text = text;
  const auto a = parse_number(from, '.'), b = parse_number(to, '.');
  if (a && b) {
    v.from = *a, v.to = *b;
    return v.to > v.from ? std::optional(v) : std::nullopt;
  }
  const auto begin = instant(from), end = instant(to);
  if (!begin || !end || begin->has_zone != end->has_zone || end->ns <= begin->ns) return {};
  v.is_clock = true;
  v.has_zone = begin->has_zone;
  v.from_ns = begin->ns, v.to_ns = end->ns;
  return v;
}

std::string coverage_text(const std::vector<RecordEvents>& records) {
  double sum = 0.0;
  bool have_clocks = !records.empty();
  for (const RecordEvents& record : records) {
    sum += record.recording.facts.last - record.recording.facts.first;
    have_clocks &= record.clock_ns.has_value();
  }
  std::string text = records.size() == 1 ? "The record covers " : "The records cover ";
  text += span_text(sum);
  if (have_clocks)
    text += ", from " + clock_text(records.front(), records.front().recording.facts.first) + " to " +
            clock_text(records.back(), records.back().recording.facts.last);
  else if (records.size() == 1)
    text += ", from " + rounded_text(records.front().recording.facts.first, 7) + " s to " +
            rounded_text(records.front().recording.facts.last, 7) + " s of its own clock";
  return text + ".";
}

std::optional<double> covered_share(const std::vector<RecordEvents>& records, const std::optional<Voyage>& voyage) {
  if (!voyage || (!voyage->is_clock && records.size() > 1)) return {};
  for (const RecordEvents& record : records)
    if (record.recording.layout.is_peaks || (voyage->is_clock && (!record.clock_ns || record.clock_has_zone != voyage->has_zone)))
      return {};
  return 1.0 - uncovered_of(records, *voyage).sum / length_of(*voyage);
}

std::optional<MissingEvidence> uncovered(const std::vector<RecordEvents>& records, const std::optional<Voyage>& voyage) {
  const std::string seen = coverage_text(records);
  if (!voyage)
    return missing(seen + " Nothing says that this is the whole journey.", "Say when the journey began and ended (voyage FROM,TO).");
  double greatest = 0.0;
  for (const RecordEvents& record : records) {
    if (record.recording.layout.is_peaks)
      return missing("'" + record.file + "' is a list of peaks, which does not state when the recorder was on.",
                     "Read a record with waveforms.");
    greatest = std::max(greatest, largest_motion(record));
    if (!voyage->is_clock) continue;
    if (!record.clock_ns)
      return missing("'" + record.file + "' does not state the date and time at which it began.",
                     "Give the voyage in the record's own seconds, one record at a time.");
    if (record.clock_has_zone != voyage->has_zone)
      return missing("'" + record.file + "' states its time " + (record.clock_has_zone ? "with" : "without") + " a time zone, the voyage " +
                         (voyage->has_zone ? "with" : "without") + " one: they cannot be compared.",
                     record.clock_has_zone ? "Give the voyage with zones, as in \"2016-01-04 10:00Z, 2016-01-06 18:00Z\"."
                                           : "Give the voyage without zones, in the time of the recorder.");
  }
  if (!voyage->is_clock && records.size() > 1)
    return missing("The voyage is given in seconds of one record, and there are " + std::to_string(records.size()) + ".",
                   "Give two dates with times of day.");
  if (const UncoveredTime u = uncovered_of(records, *voyage); u.sum > 0.0)
    return missing(seen + " The journey was said to last " + voyage->text + ": " + span_text(u.sum) + " of it are not covered, the first " +
                       span_text(u.to - u.from) + " from " +
                       (voyage->is_clock ? stamp_text(voyage->from_ns + static_cast<std::int64_t>(std::llround(u.from * 1e9))).substr(0, 19)
                                         : rounded_text(voyage->from + u.from, 7) + " s") +
                       " on.",
                   "Give the records of the rest as well.");
  if (greatest < k_alive)
    return missing("No axis moved by more than " + rounded_text(greatest / k_gravity, 2) +
                       " g: nothing shows that the recorder travelled at all.",
                   "Look whether the recorder sat on the machine.");
  return {};
}

} // namespace steplap::assess
