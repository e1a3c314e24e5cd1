#include "tools/assess/record_events.h"

#include "tools/assess/assumed_pulse.h"
#include "tools/assess/record_evidence.h"

#include "mbd/base/shown_text.h"
#include "mbd/io/digest.h"
#include "mbd/io/read_input.h"
#include "transformer/recorder/fields.h"
#include "transformer/recorder/time_text.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace steplap::assess {

namespace {

constexpr double k_felt = 0.5; // if the reading at rest exceeds this fraction of the threshold, it would trigger events

std::string in_g(double a) { return rounded_text(a / k_gravity, 3) + " g"; }

std::string sha256_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> part(1 << 20);
  Sha256 sum;
  while (file.read(part.data(), static_cast<std::streamsize>(part.size())), file.gcount() > 0)
    sum.add({part.data(), static_cast<std::size_t>(file.gcount())});
  return sum.hex();
}

// Computes the mean of each axis over an interval, and over its quarters.
class StretchMean : public SampleSink {
public:
  explicit StretchMean(const std::array<double, 2>& stretch) : stretch_(stretch) {}
  void begin(const RecordLayout& layout) override { axes_ = layout.axes.size(); }
  void begin_segment(std::size_t) override {}
  void put(double t, const double* a) override {
    if (t < stretch_[0] || t > stretch_[1]) return;
    const double share = (t - stretch_[0]) / (stretch_[1] - stretch_[0]);
    Sums& quarter = quarters_[std::min(quarters_.size() - 1, static_cast<std::size_t>(4.0 * share))];
    for (Sums* const sums : {&all_, &quarter}) {
      ++sums->count;
      for (std::size_t i = 0; i < axes_; ++i) sums->of_axes[i] += a[i];
    }
  }
  void end_segment() override {}
  [[nodiscard]] std::size_t count() const { return all_.count; }
  [[nodiscard]] std::array<double, 3> means() const {
    std::array<double, 3> means{};
    for (std::size_t i = 0; i < axes_; ++i) means[i] = all_.mean(i);
    return means;
  }
  // Returns the largest difference between the means of two quarters of the interval.
  [[nodiscard]] double change(std::size_t axis) const {
    double least = all_.mean(axis), greatest = least;
    for (const Sums& quarter : quarters_)
      if (quarter.count > 0) least = std::min(least, quarter.mean(axis)), greatest = std::max(greatest, quarter.mean(axis));
    return greatest - least;
  }

private:
  struct Sums {
    std::size_t count = 0;
    std::array<double, 3> of_axes{};
    [[nodiscard]] double mean(std::size_t axis) const { return of_axes[axis] / static_cast<double>(count); }
  };
  std::array<double, 2> stretch_;
  std::size_t axes_ = 0;
  Sums all_;
  std::array<Sums, 4> quarters_;
};

StretchMean rest_of(const std::string& file, const EventReading& reading) {
  StretchMean mean(*reading.rest);
  LineSource source(file);
  static_cast<void>(read_record(source, reading.read, mean));
  if (mean.count() < 2)
    throw FileError(file, "'" + file + "' has no two samples from " + rounded_text((*reading.rest)[0]) + " s to " +
                              rounded_text((*reading.rest)[1]) + " s: give a stretch at rest within the record");
  return mean;
}

// Notes if the mean that is subtracted is not constant over its interval, because it then contains braking or a curve. Vibration does not
// change it.
void check_rest(const StretchMean& rest, RecordEvents& record) {
  // largest change of the mean, m/s²; 50 mg already change the required pressure by 10 % (docs/evidence/recorders.md)
  constexpr double k_still = 0.05 * k_gravity;
  for (std::size_t i = 0; i < record.recording.layout.axes.size(); ++i)
    if (const double change = rest.change(i); change > k_still)
      return record.missing.push_back({Evidence::unit,
                                       "In the stretch that was named as rest axis " +
                                           std::string(1, record.recording.layout.axes[i].axis) + " changes by " + in_g(change) +
                                           ": its mean, which is subtracted, is not that of rest.",
                                       "Name a stretch in which nothing moved."});
}

// Subtracts gravity from the axis given by the user. The axes of a record are known only after its columns have been read.
class WithoutGravity : public SampleSink {
public:
  WithoutGravity(Conditioning conditioning, const EventReading& reading, SignalSink& sink)
      : conditioning_(conditioning), reading_(reading), sink_(sink) {}
  void begin(const RecordLayout& layout) override {
    if (reading_.gravity && *reading_.gravity != "none" && !layout.is_peaks) { // assumed_pulse.h subtracts gravity from lists of peaks
      const bool is_turned = reading_.gravity->starts_with('-');
      const std::string axis = reading_.gravity->substr(is_turned ? 1 : 0);
      const auto found =
          std::find_if(layout.axes.begin(), layout.axes.end(), [&](const AxisColumn& each) { return axis == std::string(1, each.axis); });
      if (found == layout.axes.end())
        throw FileError(layout.file, "gravity along '" + *reading_.gravity + "': '" + layout.file + "' has no such axis");
      conditioning_.offset[static_cast<std::size_t>(found - layout.axes.begin())] += is_turned ? -k_gravity : k_gravity;
    }
    if (conditioning_.rate && *conditioning_.rate < layout.time.rate * (1.0 - 1e-9))
      throw FileError(layout.file, "'" + layout.file + "' has " + rounded_text(layout.time.rate) +
                                       " Hz: fewer samples would fold high frequencies into low ones");
    axes_ = layout.axes.size();
    conditioner_.emplace(conditioning_, sink_);
    conditioner_->begin(layout);
  }
  void begin_segment(std::size_t line) override {
    conditioner_->begin_segment(line);
    fall_.begin_segment();
  }
  void put(double t, const double* a) override {
    conditioner_->put(t, a);
    fall_.put(t, a, axes_);
    watch_.put(t, a, axes_);
  }
  void end_segment() override { conditioner_->end_segment(); }
  [[nodiscard]] const Conditioner& conditioner() const { return *conditioner_; }
  [[nodiscard]] const Conditioning& conditioning() const { return conditioning_; }
  [[nodiscard]] const FallWatch& fall() const { return fall_; }
  [[nodiscard]] AxisWatch& axes() { return watch_; }

private:
  Conditioning conditioning_;
  const EventReading& reading_;
  SignalSink& sink_;
  std::optional<Conditioner> conditioner_;
  FallWatch fall_;
  AxisWatch watch_;
  std::size_t axes_ = 0;
};

Conditioning conditioning_of(const EventReading& reading) {
  Conditioning conditioning;
  conditioning.frequency_class = reading.frequency_class;
  conditioning.rate = reading.rate;
  return conditioning;
}

// Reads the signal of a file and subtracts its offset: gravity along a given axis, or the reading at rest.
Recording read_signal(const std::string& file, const EventReading& reading, WithoutGravity& first) {
  LineSource source(file);
  ReadOptions options = reading.read;
  options.rest = reading.rest;
  return read_record(source, options, first);
}

void refuse_gravity_as_shock(const RecordEvents& record) {
  const RecordLayout& layout = record.recording.layout;
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    const double rest = record.rest[i] - record.offset[i];
    if (std::abs(rest) < k_felt * record.rules.threshold) continue;
    throw FileError(record.file, "axis " + std::string(1, layout.axes[i].axis) + " of '" + record.file + "' reads " + in_g(rest) +
                                     " at rest, which would count towards the threshold of " + in_g(record.rules.threshold) +
                                     ": the model has gravity already, so subtract it from the record, or what the record reads at rest");
  }
}

// Returns the corner frequency of the recorder's built-in low-pass filter, if the file's header gives it, Hz; otherwise infinity.
double stated_low_pass(const RecordEvents& record) {
  LineSource source(record.file);
  std::vector<HeaderLine> lines;
  for (std::string_view text; lines.size() < record.recording.layout.shape.first_data && source.next(text);)
    lines.push_back({source.number(), std::string(text)});
  return low_pass_of(metadata_of(lines)).value_or(std::numeric_limits<double>::infinity());
}

// Sets the clock time at time 0 of the record, if the header gives date and time of its start.
void read_clock(RecordEvents& record) {
  const RecordLayout& layout = record.recording.layout;
  std::string text = layout.time.start.substr(0, layout.time.start.find(" ("));
  const bool is_utc = text.ends_with(" UTC");
  if (is_utc) text.resize(text.size() - 4);
  const unsigned orders = possible_date_orders(text);
  if (orders == 0 || (orders & (orders - 1)) != 0) return; // the date is invalid, or its order of day and month is ambiguous
  const auto stamp = parse_stamp(text, orders);
  if (!stamp || !stamp->has_date || !stamp->has_clock) return;
  record.clock_ns = stamp->ns;
  record.clock_has_zone = is_utc || stamp->has_zone;
}

} // namespace

double RecordEvents::size_at_rest() const {
  double sum = 0.0;
  for (const double value : rest) sum += value * value;
  return std::sqrt(sum);
}

std::optional<std::size_t> RecordEvents::axis(char letter) const {
  const std::size_t index = axes().find(letter);
  return index == std::string::npos ? std::nullopt : std::optional(index);
}

std::string RecordEvents::axes() const {
  if (pulse) return "xyz"; // pulses have all three axes; missing ones are zero
  std::string letters;
  for (const AxisColumn& each : recording.layout.axes) letters += each.axis;
  return letters;
}

RecordEvents read_without_events(const std::string& file, const EventReading& reading) {
  if (is_standard_input(file)) throw FileError(file, "a decision names its record: give a file, not standard input");
  RecordEvents record;
  record.file = file;
  record.rules = reading.rules;
  Conditioning conditioning = conditioning_of(reading);
  std::optional<StretchMean> rest;
  if (reading.rest) conditioning.offset = rest.emplace(rest_of(file, reading)).means();
  // level of the record's begin and end, as a fraction of a shock; a larger signal there means a shock that was cut off
  constexpr double k_within = 0.25;
  SignalWatch signal(k_within * shock_level(reading.rules));
  WithoutGravity first(conditioning, reading, signal);
  record.recording = read_signal(file, reading, first);
  record.sha256 = sha256_of(file);
  read_clock(record);
  record.fall = first.fall();
  first.axes().finish();
  for (std::size_t i = 0; i < record.recording.layout.axes.size(); ++i)
    record.rest[i] = reading.rest ? conditioning.offset[i] : first.axes().rest(i);
  if (record.recording.layout.is_peaks) {
    record.pulse = reading.pulse;
    find_missing_evidence(first.axes(), signal, record);
    if (record.pulse) add_assumed_pulses(reading, record);
    return record;
  }
  record.offset = first.conditioning().offset;
  record.rate = first.conditioner().rate();
  record.bandwidth = std::min(first.conditioner().bandwidth(), stated_low_pass(record));
  record.is_filtered = reading.frequency_class.has_value();
  record.greatest = signal.greatest();
  record.sustained = signal.sustained();
  if (rest) check_rest(*rest, record);
  find_missing_evidence(first.axes(), signal, record);
  if (!reading.gravity || *reading.gravity != "none") refuse_gravity_as_shock(record);
  return record;
}

bool find_events(const EventReading& reading, const EventRules& rules, double longest_total, RecordEvents& record) {
  record.events.clear();
  Conditioning conditioning = conditioning_of(reading);
  if (reading.rest) conditioning.offset = rest_of(record.file, reading).means();
  double sum = 0.0;
  ShockFinder finder(rules, [&](const ShockEvent& event, const Window& window) {
    sum += event.end - event.begin;
    if (sum > longest_total) return;
    const auto is_beyond = [&](const AxisEvent& axis) { return std::abs(axis.peak) > record.rules.threshold; };
    record.events.push_back({event, window, std::none_of(event.axes.begin(), event.axes.end(), is_beyond)});
  });
  WithoutGravity first(conditioning, reading, finder);
  static_cast<void>(read_signal(record.file, reading, first));
  if (sum <= longest_total) return true;
  record.events.clear();
  return false;
}

RecordEvents read_events(const std::string& file, const EventReading& reading) {
  RecordEvents record = read_without_events(file, reading);
  if (!record.recording.layout.is_peaks)
    static_cast<void>(find_events(reading, reading.rules, std::numeric_limits<double>::infinity(), record));
  return record;
}

void order_records(std::vector<RecordEvents>& records, std::string& note, bool& is_known) {
  is_known = true;
  if (records.size() < 2) return;
  const bool have_clocks = std::all_of(records.begin(), records.end(), [](const RecordEvents& r) { return r.clock_ns.has_value(); });
  const bool are_alike = std::all_of(records.begin(), records.end(),
                                     [&](const RecordEvents& r) { return r.clock_has_zone == records.front().clock_has_zone; });
  if (have_clocks && !are_alike) {
    note =
        "Some records state their time with a zone and some without, which cannot be compared: they are taken in the order in which they "
        "were given.";
    is_known = false;
    return;
  }
  if (!have_clocks) {
    note = "Not every record states when it began: they are taken one after the other, in the given order.";
    return;
  }
  std::stable_sort(records.begin(), records.end(), [](const RecordEvents& a, const RecordEvents& b) { return *a.clock_ns < *b.clock_ns; });
  for (std::size_t i = 1; i < records.size(); ++i) {
    const RecordEvents &a = records[i - 1], &b = records[i];
    const double begins = 1e-9 * static_cast<double>(*b.clock_ns - *a.clock_ns) + b.recording.facts.first;
    if (begins < a.recording.facts.last)
      throw FileError(b.file,
                      "'" + b.file + "' begins before '" + a.file + "' ends: records of one time are not one voyage. Give one of them");
  }
  note = "The records are taken in the order of their clocks.";
}

} // namespace steplap::assess
