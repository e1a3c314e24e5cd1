#include "transformer/recorder/recorder_signal.h"

#include "mbd/base/limits.h"
#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/digest.h"
#include "mbd/io/input_files.h"
#include "mbd/io/read_input.h"
#include "transformer/recorder/events.h"
#include "transformer/recorder/fields.h"
#include "transformer/recorder/option_words.h"
#include "transformer/recorder/reader.h"
#include "transformer/recorder/record_error.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace steplap {

namespace {

using Text = std::optional<std::string>;
const std::vector<std::string> k_directions{"x", "-x", "y", "-y", "z", "-z"};

constexpr double k_recorder_noise = 0.05 * k_gravity; // largest value of an axis that only reads noise, m/s²

struct Recorder : SignalDefinition {
  std::string file, sha256;
  Text axis;
  std::vector<double> map;
  Text x, y, z, time, time_unit, unit, delimiter, decimal, dates; // fields as in ReadOptions
  std::optional<double> rate, counts_per_g;
  std::string missing = "refuse", repeated = "refuse", backward = "refuse";
  bool holds = false;
  double gap = ReadOptions{}.gap;
  Text gravity;
  std::vector<double> rest; // interval at rest: begin and end, s
  std::optional<double> cfc, resample;
  std::optional<double> from, to; // interval of the record, s
  std::optional<long> event;
  double threshold = EventRules::k_default_threshold;
  std::string drift = "none";
  double factor = 1.0;
  double start = 0.0; // time in the run at which the window begins, s
};

[[noreturn]] void fail(const Recorder& r, const std::string& what) { throw ModelError(r.where, "recorder '" + r.name + "': " + what); }

ReadOptions read_options(const Recorder& r) {
  ReadOptions o;
  o.x = r.x, o.y = r.y, o.z = r.z, o.time = r.time, o.time_unit = r.time_unit, o.unit = r.unit;
  o.rate = r.rate, o.counts_per_g = r.counts_per_g, o.holds = r.holds, o.gap = r.gap;
  if (r.delimiter) o.delimiter = *meaning_of(k_delimiters, *r.delimiter);
  if (r.decimal) o.decimal = *meaning_of(k_decimals, *r.decimal);
  if (r.dates) o.dates = *meaning_of(k_dates, *r.dates);
  if (r.rest.size() == 2) o.rest = {r.rest[0], r.rest[1]};
  o.missing = *meaning_of(k_missing, r.missing);
  o.repeated = *meaning_of(k_repeated, r.repeated);
  o.backward = *meaning_of(k_backward, r.backward);
  return o;
}

// Stores all samples of a file, segment by segment.
struct Samples : SampleSink {
  struct Row {
    double t = 0.0;
    std::array<double, 3> a{};
  };
  struct Segment {
    std::size_t line = 0;
    std::vector<Row> rows;
  };
  std::vector<Segment> segments;
  std::size_t axes = 0;

  void begin(const RecordLayout& layout) override { axes = layout.axes.size(); }
  void begin_segment(std::size_t line) override { segments.push_back({line, {}}); }
  void put(double t, const double* a) override {
    Row row{t, {}};
    std::copy_n(a, axes, row.a.begin());
    segments.back().rows.push_back(row);
  }
  void end_segment() override {}
};

// Stores the filtered signal of all segments and finds the requested event.
struct Conditioned : SignalSink {
  std::size_t axes = 0;
  double rate = 0.0;
  std::vector<Window> segments;

  void begin(const RecordLayout& layout, double new_rate) override {
    axes = layout.axes.size();
    rate = new_rate;
  }
  void begin_segment(std::size_t) override {
    segments.emplace_back();
    segments.back().rate = rate;
  }
  void put(double t, const double*, const double* filtered) override {
    segments.back().times.push_back(t);
    for (std::size_t i = 0; i < axes; ++i) segments.back().filtered[i].push_back(filtered[i]);
  }
  void end_segment() override {}
};

// Returns the index of an axis in the record and its sign, for example −1 for "-z".
std::pair<std::size_t, double> axis_of(const Recorder& r, const RecordLayout& layout, const std::string& text, const char* field) {
  const char letter = text.back();
  const auto found = std::find_if(layout.axes.begin(), layout.axes.end(), [&](const AxisColumn& each) { return each.axis == letter; });
  if (found == layout.axes.end())
    fail(r, std::string("'") + field + "' is " + text + ", but the record has no axis " + letter + ": name its column by '" + letter + "'");
  return {static_cast<std::size_t>(found - layout.axes.begin()), text.front() == '-' ? -1.0 : 1.0};
}

// Returns the components of the signal's direction along the axes of the record.
std::array<double, 3> direction_of(const Recorder& r, const RecordLayout& layout) {
  if (r.axis.has_value() == !r.map.empty()) fail(r, "give 'axis', such as \"x\" or \"-z\", or 'map', the three shares of x, y and z");
  std::array<double, 3> direction{};
  if (r.axis) {
    const auto [k, sign] = axis_of(r, layout, *r.axis, "axis");
    direction[k] = sign;
    return direction;
  }
  if (r.map.size() != 3) fail(r, "'map' must have three numbers, the shares of x, y and z, got " + std::to_string(r.map.size()));
  constexpr double k_rough = 1e-3; // tolerance of the length of typed directions
  const double length = std::sqrt(r.map[0] * r.map[0] + r.map[1] * r.map[1] + r.map[2] * r.map[2]);
  if (std::abs(length - 1.0) > k_rough)
    fail(r, "'map' must be a direction of length 1, got one of length " + rounded_text(length) + "; a scale is 'factor'");
  for (int i = 0; i < 3; ++i)
    if (r.map[i] != 0.0) direction[axis_of(r, layout, k_directions[2 * i], "map").first] = r.map[i];
  return direction;
}

std::array<double, 3> offset_of(const Recorder& r, const Recording& recording, const Samples& samples,
                                const std::array<double, 3>& direction) {
  std::array<double, 3> offset{};
  if (!r.rest.empty()) {
    if (r.rest.size() != 2 || !(r.rest[1] > r.rest[0])) fail(r, "'rest' must be two times of the record that ascend");
    std::size_t count = 0;
    for (const Samples::Segment& segment : samples.segments)
      for (const Samples::Row& row : segment.rows) {
        if (row.t < r.rest[0] || row.t > r.rest[1]) continue;
        ++count;
        for (std::size_t i = 0; i < 3; ++i) offset[i] += row.a[i];
      }
    if (count < 2) fail(r, "the record has no two samples within 'rest'");
    for (double& each : offset) each /= static_cast<double>(count);
  }
  if (r.gravity && *r.gravity != "none") {
    if (!r.rest.empty()) fail(r, "give 'gravity' or 'rest', not both: the mean at rest has gravity in it");
    const auto [k, sign] = axis_of(r, recording.layout, *r.gravity, "gravity");
    offset[k] = sign * k_gravity;
  }
  constexpr double k_felt = 0.5 * k_gravity; // reading at rest, m/s², above which 'gravity' or 'rest' must be given
  double felt = 0.0;
  for (std::size_t i = 0; i < recording.layout.axes.size(); ++i) felt += direction[i] * recording.facts.axes[i].rest;
  if (!r.gravity && r.rest.empty() && std::abs(felt) > k_felt)
    fail(r,
         "it reads " + rounded_text(felt / k_gravity, 3) + " g at rest: say which axis gravity is on by 'gravity', or \"none\" to keep it");
  return offset;
}

// Cuts out the requested window: an event, or an interval of time within one segment.
Window window_of(const Recorder& r, const Conditioned& signal, const std::vector<Window>& events) {
  if (r.event) {
    if (r.from || r.to) fail(r, "give 'event' or 'from' and 'to', not both");
    if (*r.event > static_cast<long>(events.size()))
      fail(r, "'event' is " + std::to_string(*r.event) + ", but the record has " + counted(events.size(), "event", "events") +
                  " beyond 'threshold'");
    return events[static_cast<std::size_t>(*r.event) - 1];
  }
  Window found;
  int segments = 0;
  for (const Window& segment : signal.segments) {
    const auto begin = r.from ? std::lower_bound(segment.times.begin(), segment.times.end(), *r.from) : segment.times.begin();
    const auto end = r.to ? std::upper_bound(segment.times.begin(), segment.times.end(), *r.to) : segment.times.end();
    if (end - begin < 2) continue;
    ++segments;
    const auto a = begin - segment.times.begin(), b = end - segment.times.begin();
    found.times.assign(begin, end);
    for (std::size_t i = 0; i < signal.axes; ++i)
      found.filtered[i].assign(segment.filtered[i].begin() + a, segment.filtered[i].begin() + b);
  }
  if (segments == 0) fail(r, "the record has no two samples from 'from' to 'to'");
  if (segments > 1)
    fail(r, "gaps part the record into " + std::to_string(segments) + " segments: choose one by 'event', or by 'from' and 'to'");
  return found;
}

Signal signal_of(const Recorder& r, const Window& window, const std::array<double, 3>& direction) {
  std::vector<double> values(window.times.size(), 0.0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < values.size() && direction[i] != 0.0; ++k) values[k] += r.factor * direction[i] * window.filtered[i][k];
  const double begin = window.times.front(), length = window.times.back() - begin;
  double mean = 0.0; // constant acceleration that makes the velocity at the end equal that at the begin
  for (std::size_t k = 1; k < values.size() && r.drift == "line"; ++k)
    mean += 0.5 * (values[k - 1] + values[k]) * (window.times[k] - window.times[k - 1]) / length;
  std::vector<Signal::Piece> pieces(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    pieces[k].start = r.start + (window.times[k] - begin);
    pieces[k].c[0] = values[k] - mean;
    if (k > 0) pieces[k - 1].c[1] = (pieces[k].c[0] - pieces[k - 1].c[0]) / (pieces[k].start - pieces[k - 1].start);
  }
  pieces.back().c[0] = 0.0;
  Signal signal(std::move(pieces));
  signal.doubt_cut_end(k_recorder_noise);
  signal.doubt_cut_begin(k_recorder_noise);
  return signal;
}

// Adds a doubt for each axis of the signal with samples within the window that were cut off by the recorder's range.
void doubt_clipped(const Recording& recording, const Samples& samples, const Window& window, const std::array<double, 3>& direction,
                   Signal& signal) {
  const RecordLayout& layout = recording.layout;
  for (std::size_t i = 0; i < layout.axes.size(); ++i) {
    if (direction[i] == 0.0) continue;
    const AxisFacts& facts = recording.facts.axes[i];
    const bool has_flat_top = facts.flat_longest >= 3 && !layout.holds;
    std::size_t clipped = 0;
    double top = 0.0;
    for (const Samples::Segment& segment : samples.segments)
      for (const Samples::Row& row : segment.rows) {
        if (row.t < window.times.front() || row.t > window.times.back()) continue;
        const bool saturates = layout.range && std::abs(row.a[i]) >= k_saturates * *layout.range;
        if (!saturates && !(has_flat_top && row.a[i] == facts.flat_value)) continue;
        ++clipped;
        top = row.a[i];
      }
    if (clipped > 0)
      signal.add_doubt(signal.breakpoints().front(), std::string("axis ") + layout.axes[i].axis + " is at " +
                                                         rounded_text(top / k_gravity, 3) + " g in " +
                                                         counted(clipped, "sample", "samples") +
                                                         ": it is clipped, and its peaks were higher. Take a recorder with a larger range");
  }
}

Signal read_signal(const Recorder& r) {
  const std::string text = read_input(r.file, r.where, "the record ");
  note_input(r.file, text, true);
  if (!r.sha256.empty() && sha256(text) != r.sha256)
    fail(r, "'" + r.file + "' is not the file that was meant: its SHA-256 is " + sha256(text) +
                ". Take the file of that time, or drop 'sha256' to take this one");
  LineSource source(text, r.file);
  Samples samples;
  const Recording recording = read_record(source, read_options(r), samples);
  if (recording.layout.is_peaks)
    fail(r, "'" + r.file +
                "' holds peaks without waveforms: use a half_sine with such a peak and duration, and say that its shape is assumed");
  const std::array<double, 3> direction = direction_of(r, recording.layout);
  Conditioned signal;
  std::vector<Window> events;
  EventRules rules;
  rules.threshold = r.threshold;
  ShockFinder finder(rules, [&events](const ShockEvent&, const Window& window) { events.push_back(window); });
  Conditioning conditioning{offset_of(r, recording, samples, direction), r.cfc, r.resample, {}, {}};
  if (r.resample && *r.resample < recording.layout.time.rate * (1.0 - 1e-9))
    fail(r, "'resample' is below the record's " + rounded_text(recording.layout.time.rate) +
                " Hz, which would fold high frequencies into low ones: keep the rate and filter by 'cfc'");
  if (r.resample && *r.resample > k_most_resampling * recording.layout.time.rate)
    fail(r, "'resample' may be at most " + rounded_text(k_most_resampling) + " times the record's " +
                rounded_text(recording.layout.time.rate) + " Hz");
  SignalSink& sink = r.event ? static_cast<SignalSink&>(finder) : signal;
  Conditioner conditioner(conditioning, sink);
  conditioner.begin(recording.layout);
  for (const Samples::Segment& segment : samples.segments) {
    conditioner.begin_segment(segment.line);
    for (const Samples::Row& row : segment.rows) conditioner.put(row.t, row.a.data());
    conditioner.end_segment();
  }
  const Window window = window_of(r, signal, events);
  Signal result = signal_of(r, window, direction);
  doubt_clipped(recording, samples, window, direction, result);
  return result;
}

Signal build_recorder(const SignalDefinition& definition) {
  const auto& recorder = static_cast<const Recorder&>(definition);
  try {
    return read_signal(recorder);
  } catch (const RecordError& error) {
    fail(recorder, std::string(error.what()) + " (Here options are fields of the signal: --counts-per-g is 'counts_per_g'.)");
  }
}

void add_reading_fields(FieldTable& f) {
  f.add("x", &Recorder::x).doc("column of axis x by name or number from 1; - before it turns the sign");
  f.add("y", &Recorder::y).doc("column of axis y");
  f.add("z", &Recorder::z).doc("column of axis z");
  f.add("time", &Recorder::time).doc("column of times, or \"none\"");
  f.add("time_unit", &Recorder::time_unit).doc("s, ms, epoch, \"epoch ms\" or days");
  f.add("rate", &Recorder::rate).in("Hz").positive().doc("of sampling, where there is no column of times");
  f.add("unit", &Recorder::unit).one_of({"g", "mg", "m/s^2", "counts"}).doc("of the accelerations in the file");
  f.add("counts_per_g", &Recorder::counts_per_g).positive().doc("scale of counts");
  f.add("delimiter", &Recorder::delimiter).one_of(words_of(k_delimiters)).doc("sign between columns");
  f.add("decimal", &Recorder::decimal).one_of(words_of(k_decimals)).doc("decimal sign");
  f.add("dates", &Recorder::dates).one_of(words_of(k_dates)).doc("order of day and month");
  f.add("missing", &Recorder::missing).one_of(words_of(k_missing)).doc("rows without a value");
  f.add("repeated", &Recorder::repeated).one_of(words_of(k_repeated)).doc("two rows of one time");
  f.add("backward", &Recorder::backward).one_of(words_of(k_backward)).doc("a time before that of the row before");
  f.add("holds", &Recorder::holds).doc("samples that are left out keep the value before them");
  f.add("gap", &Recorder::gap).at_least(1.5).doc("in sampling intervals: what is longer parts the record");
}

void add_conditioning_fields(FieldTable& f) {
  std::vector<std::string> gravity = k_directions;
  gravity.insert(gravity.begin(), "none");
  f.add("gravity", &Recorder::gravity).one_of(std::move(gravity)).doc("axis that reads 1 g at rest, which is subtracted; none: it is kept");
  f.add("rest", &Recorder::rest).in("s").doc("two times of the record between which it is at rest: the mean is subtracted");
  f.add("cfc", &Recorder::cfc).in("Hz").positive().doc("channel frequency class of a low-pass without phase shift (ISO 6487)");
  f.add("resample", &Recorder::resample).in("Hz").positive().doc("rate of the signal; that of the record if not given");
  f.add("event", &Recorder::event).at_least(1.0).doc("number of the event that is taken, from 0.1 s before to 0.3 s after it");
  f.add("threshold", &Recorder::threshold).in("m/s^2").positive().doc("beyond which there is an event");
  f.add("from", &Recorder::from).in("s").doc("time of the record where the window begins; its first if not given");
  f.add("to", &Recorder::to).in("s").doc("time of the record where it ends");
  f.add("drift", &Recorder::drift).one_of({"none", "line"}).doc("line: a constant is taken away, so that velocity ends as it began");
  f.add("factor", &Recorder::factor).doc("on the values");
  f.add("start", &Recorder::start).in("s").doc("time of the run at which the window begins");
}

} // namespace

const SignalKind& recorder_signal_kind() {
  static const SignalKind kind = [] {
    SignalKind k;
    k.name = "recorder";
    k.doc = "Acceleration (m/s^2) along a direction from the file of a shock recorder, read as `steplap record` reads it, whose "
            "options are fields here. "
            "Linear between samples, 0 outside the window.";
    k.holds<Recorder>();
    k.build = build_recorder;
    FieldTable& f = k.fields;
    f.add("file", &Recorder::file).as(FieldType::file).required().doc("of the recorder, relative to the model file");
    f.add("axis", &Recorder::axis).one_of(k_directions).doc("axis of the record that the signal takes");
    f.add("map", &Recorder::map).doc("instead of an axis: the signal's direction in the record's axes, three numbers");
    add_conditioning_fields(f);
    add_reading_fields(f);
    f.add("sha256", &Recorder::sha256).doc("SHA-256 of the file: another content is refused. Results give it");
    return k;
  }();
  return kind;
}

} // namespace steplap
