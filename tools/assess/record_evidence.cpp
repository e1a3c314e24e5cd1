#include "tools/assess/record_evidence.h"

#include "mbd/base/shown_text.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

namespace steplap::assess {

namespace {

// fraction of the threshold: smaller constant values are not clipping; larger values at a gap indicate a shock in it
constexpr double k_felt = 0.5;
constexpr double k_least_band =
    49.0; // Hz; with 25 Hz the required pressure of a joint has errors up to 22 %, with 50 Hz up to 4 % (docs/evidence/recorders.md)
constexpr double k_no_gravity = 0.02 * k_gravity, k_gravity_seen = 0.9 * k_gravity,
                 k_gravity_most = 1.1 * k_gravity; // magnitudes at rest without gravity, with gravity, and impossible ones, m/s²
// largest tolerable offset, m/s²; 50 mg already change the required pressure by 10 % (docs/evidence/recorders.md)
constexpr double k_offset = 0.1 * k_gravity;
// longest harmless gap, s; a shock within it has frequencies above 100 Hz, to which joints do not respond
constexpr double k_harmless_hole = 0.005;

std::string in_g(double a) { return rounded_text(a / k_gravity, 3) + " g"; }

bool is_flat(const AxisFacts& axis, double threshold) {
  return axis.flat_longest >= 3 && std::abs(axis.flat_value - axis.rest) > k_felt * threshold;
}

std::string letter(const RecordEvents& record, std::size_t axis) { return {record.recording.layout.axes[axis].axis}; }

class Finder {
public:
  Finder(const AxisWatch& axes, const SignalWatch& signal, RecordEvents& record)
      : record_(record), layout_(record.recording.layout), facts_(record.recording.facts), axes_(axes), signal_(signal) {}

  void find() {
    if (layout_.is_peaks)
      add(Evidence::peaks,
          std::string("The record holds peaks and no waveform: ") +
              (record_.pulse ? "models are driven by pulses that are assumed." : "no model can be driven by it."),
          "Give the waveforms.");
    else find_clipped();
    find_gaps();
    find_ends();
    find_remarks();
    if (const std::string impossible = impossible_reading(record_.recording); !impossible.empty())
      add(Evidence::unit, impossible, "Check the unit, or the counts that are 1 g.");
    if (layout_.is_peaks) return;
    find_fall();
    find_dead();
    find_unit();
    if (record_.bandwidth < k_least_band)
      add(Evidence::bandwidth,
          "The models are driven by frequencies up to " + rounded_text(record_.bandwidth, 3) +
              " Hz: with less than 50 Hz the computed required pressure is too low.",
          record_.is_filtered ? "Give a higher frequency class, or none." : "A record of 100 samples per second or more is needed.");
  }

private:
  void add(Evidence item, const std::string& reason, const std::string& remedy) { record_.missing.push_back({item, reason, remedy}); }

  void find_clipped() {
    for (std::size_t i = 0; i < layout_.axes.size(); ++i) {
      const AxisFacts& axis = facts_.axes[i];
      // Constant values near rest are not clipping; they occur, for example, before a signal without noise.
      const bool is_flat_top = is_flat(axis, record_.rules.threshold) && !layout_.holds;
      if (axis.beyond_range.count == 0 && !is_flat_top) continue;
      return add(Evidence::clipped,
                 "Axis " + letter(record_, i) +
                     (axis.beyond_range.count > 0 ? " reaches the end of the sensor's range" : " stays at " + in_g(axis.flat_value)) +
                     ": the record is clipped, and its peaks were higher than what the models are driven by.",
                 "Take a recorder with a larger range.");
    }
  }

  void find_gaps() {
    if (facts_.gaps.count > 0 || facts_.missing.count > 0 || facts_.backward.count > 0) {
      const Counted& first = facts_.gaps.count > 0 ? facts_.gaps : facts_.missing.count > 0 ? facts_.missing : facts_.backward;
      add(Evidence::gaps,
          "The record has gaps, the first in line " + std::to_string(first.line) +
              (facts_.longest_gap > 0.0 ? ", the longest of " + rounded_text(facts_.longest_gap, 3) + " s" : "") +
              ": what happened in them is not known.",
          "Copy the file again from the recorder, or give a second record of that time.");
    } else if (facts_.block_gaps.count > 0) {
      add(Evidence::gaps,
          "The record has blocks with time between them that is not recorded (first in line " + std::to_string(facts_.block_gaps.line) +
              (std::isfinite(facts_.longest_block_gap) ? ", at most " + rounded_text(facts_.longest_block_gap, 3) + " s" : "") + ").",
          "Take a recorder that records all the time.");
    } else {
      find_holes();
    }
  }

  void find_holes() {
    const double level = k_felt * shock_level(record_.rules);
    const Hole* hole = nullptr;
    bool is_beside_shock = false;
    for (const Hole& each : facts_.hole_list) {
      double beside = 0.0;
      for (std::size_t i = 0; i < layout_.axes.size(); ++i)
        beside = std::max({beside, std::abs(each.before[i] - record_.offset[i]), std::abs(each.after[i] - record_.offset[i])});
      if (beside <= level && each.length <= k_harmless_hole) continue;
      if (!hole || (beside > level && !is_beside_shock)) hole = &each;
      is_beside_shock |= beside > level;
    }
    const bool is_list_whole = facts_.holes.count <= facts_.hole_list.size();
    if (!hole && is_list_whole) return;
    if (!hole) hole = &facts_.hole_list.back();
    add(Evidence::gaps,
        (facts_.holes.count == 1 ? std::string("The record has a hole: ")
                                 : "The record has " + std::to_string(facts_.holes.count) + " holes, one of them: ") +
            counted(hole->rows, "row is", "rows are") + " missing after " + rounded_text(hole->t, 7) + " s" +
            (is_beside_shock ? ", next to a shock." : ", and a shock of " + rounded_text(1e3 * hole->length, 3) + " ms could lie in it."),
        "Copy the file again from the recorder, or give a second record of that time.");
  }

  void find_ends() {
    if (facts_.cut_line > 0)
      add(Evidence::cut, "The last line of the record is cut: what came after it is not known.", "Copy the file again from the recorder.");
    const SignalWatch::End& end = signal_.first_end();
    if (end.count == 0) return;
    add(Evidence::cut,
        std::string("The record ") + (end.is_begin ? "begins" : "ends") + " within a shock: axis " + std::string(1, end.axis) + " reads " +
            in_g(end.value) + " at " + rounded_text(end.t, 7) + " s, and what came " + (end.is_begin ? "before" : "after") +
            " is not known.",
        "Give the record of that time as well.");
  }

  void find_remarks() {
    for (const Remark& remark : facts_.remarks) {
      if (is_ordinary_end(remark.text)) continue;
      const bool is_end = remark.rows == facts_.rows;
      return add(is_end ? Evidence::cut : Evidence::comments,
                 is_end
                     ? "The record ends with '" + remark.text + "', which may be the reason for an early end: what followed is not known."
                     : "Line " + std::to_string(remark.line) + " among the rows says '" + remark.text + "'.",
                 "Find out what it means.");
    }
    if (facts_.remarks.size() >= ReadFacts::k_most_listed)
      add(Evidence::comments, "The record has " + std::to_string(ReadFacts::k_most_listed) + " different comments or more among its rows.",
          "Read them.");
  }

  void find_fall() {
    if (record_.fall.longest() < FallWatch::k_least || record_.size_at_rest() < FallWatch::k_gravity_seen) return;
    add(Evidence::fall,
        "The recorder read less than 0.3 g, gravity included, for " + rounded_text(record_.fall.longest(), 3) + " s from " +
            rounded_text(record_.fall.at(), 7) + " s on, as if it fell.",
        "Find out what happened then.");
  }

  void find_dead() {
    if (layout_.holds) return;
    for (std::size_t i = 0; i < layout_.axes.size(); ++i) {
      if (const auto stuck = axes_.stuck(i))
        return add(Evidence::dead,
                   "Axis " + letter(record_, i) + " keeps one value or a few, without its noise, from " + rounded_text(stuck->from, 7) +
                       " s to " + rounded_text(stuck->to, 7) + " s: it did not measure.",
                   "Have the recorder checked.");
      if (axes_.is_insensitive(i))
        return add(Evidence::dead,
                   "Axis " + letter(record_, i) +
                       " moves by a few steps of its converter only, while another reads shocks: it did not measure.",
                   "Have the recorder checked.");
    }
  }

  void find_unit() {
    const double size = record_.size_at_rest();
    if (size >= k_no_gravity && (size <= k_gravity_seen || size >= k_gravity_most))
      return add(Evidence::unit, "At rest the record reads " + in_g(size) + " in all, which is neither gravity nor nothing.",
                 "Check the unit, and name a stretch at rest.");
    for (std::size_t i = 0; i < layout_.axes.size(); ++i)
      if (const double left = record_.rest[i] - record_.offset[i]; std::abs(left) > k_offset && std::abs(left) < k_gravity_seen)
        return add(Evidence::unit,
                   "Axis " + letter(record_, i) + " reads " + in_g(left) +
                       " at rest, which is left in the record and adds to its shocks, or takes from them.",
                   "Name a stretch at rest (rest FROM,TO), or let the model stand as inclined as the recorder did.");
  }

  RecordEvents& record_;
  const RecordLayout& layout_;
  const ReadFacts& facts_;
  const AxisWatch& axes_;
  const SignalWatch& signal_;
};

// Returns the width of the peak at sample `at`, in samples: the interval in which the interpolated signal exceeds `share` times the peak.
double width_at(const std::vector<double>& a, std::size_t at, double share) {
  const double sign = a[at] < 0.0 ? -1.0 : 1.0, level = share * std::abs(a[at]);
  std::size_t from = at, to = at;
  // The interval ends at two consecutive smaller samples, because one may be noise.
  while (from > 1 && (sign * a[from - 1] >= level || sign * a[from - 2] >= level)) --from;
  while (to + 2 < a.size() && (sign * a[to + 1] >= level || sign * a[to + 2] >= level)) ++to;
  const auto beyond = [&](std::size_t inside, std::size_t outside) {
    const double in = sign * a[inside], out = sign * a[outside];
    return in > level && out < level ? (in - level) / (in - out) : 0.0;
  };
  return static_cast<double>(to - from) + (from > 0 ? beyond(from, from - 1) : 0.0) + (to + 1 < a.size() ? beyond(to, to + 1) : 0.0);
}

} // namespace

double shock_level(const EventRules& rules) { return std::min(rules.threshold, EventRules::k_default_threshold); }

void find_missing_evidence(const AxisWatch& axes, const SignalWatch& signal, RecordEvents& record) { Finder(axes, signal, record).find(); }

// Reports events whose peak has a flat top. The ratio of the width at 0.9 of the peak to that at 0.5 is 0.43 for a half sine, 0.41 for a
// haversine and 0.2 for a triangle. With noise of 2 % of the peak, one half sine in 500 exceeds 0.5. A flatter top indicates a saturated
// sensor, unless it is so long that it may be braking or a curve.
void find_rounded_tops(const std::vector<RecordEvents>& records, std::vector<MissingEvidence>& missing) {
  // largest ratio of the widths; longest top that is no braking, s; smallest fraction of the record's extreme
  constexpr double k_wide = 0.5, k_longest = 0.3, k_near = 0.95;
  // smallest number of samples above 0.9 of the peak for which the width is reliable
  constexpr double k_samples = 3.0;
  constexpr double k_seen = 0.25; // smallest top, as a fraction of the threshold
  const auto is_clipped = [](const MissingEvidence& m) { return m.item == Evidence::clipped; };
  for (const RecordEvents& record : records) {
    const RecordLayout& layout = record.recording.layout;
    if (layout.is_peaks || layout.range || std::any_of(record.missing.begin(), record.missing.end(), is_clipped)) continue;
    for (std::size_t i = 0; i < layout.axes.size(); ++i) {
      double most = 0.0;
      for (const RecordedEvent& e : record.events)
        for (const double value : e.window.plain[i]) most = std::max(most, std::abs(value));
      if (most < k_seen * shock_level(record.rules)) continue;
      for (const RecordedEvent& e : record.events) {
        const std::vector<double>& a = e.window.plain[i];
        const auto found = std::max_element(a.begin(), a.end(), [](double x, double y) { return std::abs(x) < std::abs(y); });
        if (found == a.end() || std::abs(*found) < k_near * most) continue;
        // A saturated sensor reads near the largest value of the record; a falling one reads zero.
        const double read = *found + record.offset[i],
                     extreme = std::max(std::abs(record.recording.facts.axes[i].least), std::abs(record.recording.facts.axes[i].greatest));
        if (std::abs(read) < k_felt * extreme) continue;
        const auto at = static_cast<std::size_t>(found - a.begin());
        const double top = width_at(a, at, 0.9), half = width_at(a, at, 0.5);
        if (top < k_wide * half || top > k_longest * e.window.rate || top < k_samples) continue;
        missing.push_back({Evidence::clipped,
                           "'" + record.file + "': axis " + letter(record, i) + " stays near " + in_g(*found) + " for " +
                               rounded_text(1e3 * top / e.window.rate, 3) + " ms at " + rounded_text(e.window.times[at], 7) +
                               " s, as a sensor does that cannot read more.",
                           "Say how far the sensor reads (range \"16 g\")."});
        break;
      }
    }
  }
}

bool is_ordinary_end(const std::string& remark) {
  static constexpr std::array k_words = {
      "end",    "of",       "the",    "file",   "data",     "record",   "recording", "measurement", "eof",       "stop", "stopped",
      "by",     "user",     "button", "manual", "manually", "operator", "finished",  "complete",    "completed", "done", "ok",
      "normal", "normally", "at",     "on",     "rows",     "samples",  "log",       "logging",     "total",     "utc",  "and"};
  const std::string text = lower_case(remark);
  std::string word;
  bool is_known = true, has_word = false;
  const auto take = [&] {
    if (word.empty()) return;
    has_word = true;
    is_known &= std::find(k_words.begin(), k_words.end(), word) != k_words.end();
    word.clear();
  };
  for (const char c : text) {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) word += c;
    else take();
    is_known &= static_cast<unsigned char>(c) < 0x80 && c != '\\' && c != '?'; // text in other alphabets, or binary data
  }
  take();
  return is_known && (has_word || text.find_first_of("0123456789") == std::string::npos);
}

} // namespace steplap::assess
