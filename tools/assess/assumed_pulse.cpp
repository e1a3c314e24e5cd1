#include "tools/assess/assumed_pulse.h"

#include "mbd/base/diagnostics.h"
#include "mbd/base/portable_math.h"
#include "mbd/base/shown_text.h"
#include "mbd/run/quantity_text.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace steplap::assess {

namespace {

constexpr std::size_t k_axes = 3;
constexpr const char* k_letters = "xyz";
constexpr int k_intervals = 200;  // samples per pulse; the error of linear interpolation of a half sine is then 3e-5 of the peak
constexpr double k_noticed = 0.1; // peaks below this fraction of the threshold are ignored
constexpr double k_differs = 0.2; // largest relative difference between the velocity change in the list and that of the pulse

using Peaks = std::array<double, k_axes>; // peak acceleration along each axis, m/s²

struct Shape {
  PulseShape shape;
  const char* name;
  double area; // area of a pulse with height 1 and duration 1
};
constexpr Shape k_shapes[] = {{PulseShape::half_sine, "half-sine", 2.0 / std::numbers::pi},
                              {PulseShape::haversine, "haversine", 0.5},
                              {PulseShape::triangle, "triangle", 0.5}};

const Shape& shape_of(PulseShape shape) {
  return *std::find_if(std::begin(k_shapes), std::end(k_shapes), [&](const Shape& s) { return s.shape == shape; });
}

// Returns the height of the pulse at a fraction of its duration.
double height(PulseShape shape, double share) {
  const double sine = portable::sin(std::numbers::pi * share);
  switch (shape) {
  case PulseShape::half_sine: return sine;
  case PulseShape::haversine: return sine * sine;
  case PulseShape::triangle: break;
  }
  return 1.0 - std::abs(2.0 * share - 1.0);
}

double size_of(const Peaks& a) { return std::hypot(a[0], a[1], a[2]); }
double greatest_of(const Peaks& a) { return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])}); }

class PulseMaker {
public:
  PulseMaker(const EventReading& reading, RecordEvents& record)
      : pulse_(*reading.pulse), gravity_(gravity_axis(reading, record)), record_(record) {
    for (const PeakEntry& entry : record.recording.peaks)
      is_signed_ |= std::any_of(entry.axis.begin(), entry.axis.end(), [](double a) { return a < 0.0; });
  }

  void make() {
    std::array<double, k_axes> best{}; // largest peak below the threshold along each axis
    std::array<const PeakEntry*, k_axes> quiet{};
    std::vector<const PeakEntry*> chosen;
    for (const PeakEntry& entry : record_.recording.peaks) {
      const Peaks a = peaks_of(entry);
      if (greatest_of(a) > record_.rules.threshold) {
        chosen.push_back(&entry);
        continue;
      }
      for (std::size_t i = 0; i < k_axes; ++i)
        if (std::abs(a[i]) > best[i]) best[i] = std::abs(a[i]), quiet[i] = &entry;
    }
    const double least = chosen.empty() ? 0.0 : k_noticed * record_.rules.threshold;
    for (std::size_t i = 0; i < k_axes; ++i)
      if (quiet[i] && best[i] >= least && std::find(chosen.begin(), chosen.end(), quiet[i]) == chosen.end()) chosen.push_back(quiet[i]);
    std::stable_sort(chosen.begin(), chosen.end(),
                     [](const PeakEntry* a, const PeakEntry* b) { return a->line < b->line; }); // restores the order of the list
    for (const PeakEntry* const entry : chosen) add(*entry);
    say();
  }

private:
  // Returns the index of the axis that includes gravity; nothing if none does. Throws FileError if this is unknown.
  static std::optional<std::size_t> gravity_axis(const EventReading& reading, const RecordEvents& record) {
    if (!reading.gravity)
      throw FileError(record.file,
                      "whether the peaks of '" + record.file +
                          "' have gravity in them cannot be seen: say that gravity is in none of them, or the axis that it is in");
    if (*reading.gravity == "none") return {};
    const std::string letter = reading.gravity->substr(reading.gravity->starts_with('-') ? 1 : 0);
    const std::size_t axis = letter.size() == 1 ? std::string(k_letters).find(letter) : std::string::npos;
    if (axis >= k_axes || record.recording.layout.peaks.axis[axis] < 0)
      throw FileError(record.file, "gravity along '" + *reading.gravity + "': '" + record.file +
                                       "' has no peaks of that axis. Use gravity \"none\" if the list is without gravity");
    return axis;
  }

  // Returns the peak acceleration along each axis without gravity, m/s²; NaN if missing.
  Peaks peaks_of(const PeakEntry& entry) const {
    Peaks a{};
    bool has_axis = false;
    for (std::size_t i = 0; i < k_axes; ++i)
      if (std::isfinite(entry.axis[i])) a[i] = entry.axis[i], has_axis = true;
    if (has_axis) {
      // The reading at rest is 1 g along this axis. Peaks without sign that are below 1 g or opposite to gravity cannot be distinguished
      // from it and give zero.
      if (gravity_) a[*gravity_] = std::copysign(std::max(0.0, std::abs(a[*gravity_]) - k_gravity), a[*gravity_]);
      return a;
    }
    if (!std::isfinite(entry.magnitude))
      throw FileError(record_.file,
                      "line " + std::to_string(entry.line) + " of '" + record_.file + "' has no peak: add it, or remove the line");
    if (!record_.pulse->axis)
      throw FileError(record_.file, "the peak in line " + std::to_string(entry.line) + " of '" + record_.file +
                                        "' has no direction: say along which axis the pulse is taken");
    a[static_cast<std::size_t>(*record_.pulse->axis - 'x')] = std::abs(entry.magnitude);
    return a;
  }

  double length_of(const PeakEntry& entry, const Peaks& a) {
    if (entry.duration > 0.0) {
      const double change = shape_of(pulse_.shape).area * size_of(a) * entry.duration;
      if (std::abs(entry.velocity_change) > 0.0 &&
          std::abs(change - std::abs(entry.velocity_change)) > k_differs * std::abs(entry.velocity_change))
        ++other_changes_;
      return entry.duration;
    }
    if (std::abs(entry.velocity_change) > 0.0 && size_of(a) > 0.0)
      return std::abs(entry.velocity_change) / (shape_of(pulse_.shape).area * size_of(a));
    if (pulse_.duration) {
      ++assumed_lengths_;
      return *pulse_.duration;
    }
    throw FileError(record_.file, "line " + std::to_string(entry.line) + " of '" + record_.file +
                                      "' has neither a duration nor a change of velocity: give the duration "
                                      "taken to last, as in a pulse of \"" +
                                      shape_of(pulse_.shape).name + " 50 ms\"");
  }

  void add(const PeakEntry& entry) {
    const Peaks a = peaks_of(entry);
    const double length = length_of(entry, a);
    // Adds one pulse for each combination of unknown signs.
    std::vector<std::size_t> turned;
    for (std::size_t i = 0; i < k_axes; ++i)
      if (a[i] != 0.0 && !is_signed_) turned.push_back(i);
    for (unsigned way = 0; way < 1U << turned.size(); ++way) {
      Peaks b = a;
      for (std::size_t k = 0; k < turned.size(); ++k)
        if ((way >> k & 1U) != 0) b[turned[k]] = -b[turned[k]];
      add_pulse(entry, b, length);
    }
  }

  void add_pulse(const PeakEntry& entry, const Peaks& a, double length) {
    Window window;
    window.rate = k_intervals / length;
    for (int i = 0; i <= k_intervals; ++i) {
      const double share = static_cast<double>(i) / k_intervals;
      window.times.push_back(entry.t + share * length);
      for (std::size_t axis = 0; axis < k_axes; ++axis)
        window.plain[axis].push_back(i == 0 || i == k_intervals ? 0.0 : a[axis] * height(pulse_.shape, share));
    }
    window.filtered = window.plain;
    RecordedEvent event{describe_event(window, k_axes), window, greatest_of(a) <= record_.rules.threshold};
    event.event.number = record_.events.size() + 1;
    event.event.line = entry.line;
    record_.events.push_back(std::move(event));
  }

  // Describes the assumptions in sentences.
  void say() {
    std::vector<std::string>& notes = record_.assumed;
    const std::string list = "Of '" + record_.file + "' only peaks are known: ";
    notes.push_back(list + "each is taken for a " + shape_of(pulse_.shape).name +
                    " along all axes at once, from rest to rest; a missing value of an axis counts as zero" +
                    (assumed_lengths_ > 0 ? ", " + counted(assumed_lengths_, "of them", "of them") + " for " +
                                                quantity_text(*pulse_.duration, "s") + " as assumed"
                                          : "") +
                    ".");
    if (!is_signed_)
      notes.push_back(list + "no direction is given, so each is run both ways along every axis, one after the other; slid distances are "
                             "sums over all of them.");
    if (record_.pulse->axis && record_.recording.layout.peaks.magnitude >= 0)
      notes.push_back(list + "magnitudes without a direction are taken to be along " + std::string(1, *record_.pulse->axis) + ".");
    if (gravity_) notes.push_back(list + "1 g of each peak along " + std::string(1, k_letters[*gravity_]) + " is taken for gravity.");
    if (other_changes_ > 0)
      notes.push_back(list + "of " + counted(other_changes_, "entry", "entries") +
                      " the listed change of velocity differs by more than 20 % from that of a pulse with the listed peak and duration.");
  }

  const AssumedPulse& pulse_;
  std::optional<std::size_t> gravity_;
  RecordEvents& record_;
  bool is_signed_ = false;
  std::size_t assumed_lengths_ = 0, other_changes_ = 0;
};

} // namespace

std::optional<AssumedPulse> parse_assumed_pulse(std::string_view text) {
  text = trimmed_blanks(text);
  const std::string_view name = text.substr(0, text.find(' '));
  const auto* const shape = std::find_if(std::begin(k_shapes), std::end(k_shapes), [&](const Shape& s) { return name == s.name; });
  if (shape == std::end(k_shapes)) return {};
  AssumedPulse pulse;
  pulse.shape = shape->shape;
  const std::string_view rest = trimmed_blanks(text.substr(name.size()));
  if (rest.empty()) return pulse;
  const auto end = rest.find_first_not_of("0123456789.+-eE");
  const auto value = parse_number(trimmed_blanks(rest.substr(0, end)), '.');
  const auto unit = end == std::string_view::npos ? std::nullopt : time_unit(rest.substr(end));
  if (!value || !unit || !(*value > 0.0)) return {};
  pulse.duration = *value * *unit;
  return pulse;
}

void add_assumed_pulses(const EventReading& reading, RecordEvents& record) { PulseMaker(reading, record).make(); }

} // namespace steplap::assess
