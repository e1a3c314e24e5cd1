#include "tools/steplap/commands.h"

#include "mbd/base/limits.h"
#include "mbd/base/number_text.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/io/read_input.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/record_options.h"
#include "tools/steplap/text_table.h"
#include "transformer/recorder/event_pictures.h"
#include "transformer/recorder/fields.h"
#include "transformer/recorder/option_words.h"
#include "transformer/recorder/outputs.h"
#include "transformer/recorder/record_error.h"
#include "transformer/recorder/result_folder.h"
#include "transformer/recorder/synthetic.h"
#include "transformer/recorder/time_text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <ostream>

namespace steplap {

namespace {

namespace fs = std::filesystem;
using Align = TextTable::Align;

constexpr std::size_t k_shown_events = 12; // keeps the output within thirty lines
constexpr OptionWords<DriftCorrection, 2> k_drifts{{{"none", DriftCorrection::none}, {"line", DriftCorrection::line}}};

struct RecordOptions : ReadingOptions {
  std::vector<std::string> files;
  Text output, make, event, drift, high_pass;
  bool is_json = false, is_overwriting = false;
};

// Computes the mean of each axis over an interval.
class QuietMean : public SampleSink {
public:
  QuietMean(double from, double to) : from_(from), to_(to) {}
  void begin(const RecordLayout& layout) override { axes_ = layout.axes.size(); }
  void begin_segment(std::size_t) override {}
  void put(double t, const double* a) override {
    if (t < from_ || t > to_) return;
    ++count_;
    for (std::size_t i = 0; i < axes_; ++i) sums_[i] += a[i];
  }
  void end_segment() override {}
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double mean(std::size_t i) const { return sums_[i] / static_cast<double>(count_); }

private:
  double from_, to_;
  std::size_t axes_ = 0, count_ = 0;
  std::array<double, 3> sums_{};
};

std::array<double, 3> quiet_offset(const std::string& file, const std::string& quiet, const ReadOptions& options) {
  const auto [from, to] = rest_stretch(quiet);
  if (is_standard_input(file)) throw UsageError("--rest needs a file that can be read twice, not standard input");
  QuietMean mean(from, to);
  LineSource source(file);
  static_cast<void>(read_record(source, options, mean));
  if (mean.count() < 2)
    throw RecordError(source.name(), 0, 0,
                      "The record has no two samples from " + number_text(from) + " s to " + number_text(to) +
                          " s. Give a stretch within it with --rest.");
  return {mean.mean(0), mean.mean(1), mean.mean(2)};
}

// Passes the signal on to the event search and, if requested, to files.
class Tee : public SignalSink {
public:
  Tee(SignalSink& a, SignalSink* b) : a_(a), b_(b) {}
  void begin(const RecordLayout& layout, double rate) override {
    a_.begin(layout, rate);
    if (b_) b_->begin(layout, rate);
  }
  void begin_segment(std::size_t line) override {
    a_.begin_segment(line);
    if (b_) b_->begin_segment(line);
  }
  void put(double t, const double* plain, const double* filtered) override {
    a_.put(t, plain, filtered);
    if (b_) b_->put(t, plain, filtered);
  }
  void end_segment() override {
    a_.end_segment();
    if (b_) b_->end_segment();
  }

private:
  SignalSink& a_;
  SignalSink* b_;
};

// Subtracts gravity from the axis given by the user. The axes of a record are known only after its columns have been read.
class GravityFirst : public SampleSink {
public:
  GravityFirst(Conditioning conditioning, std::optional<std::string> gravity, const RecordOptions& options, SignalSink& sink)
      : conditioning_(conditioning), gravity_(std::move(gravity)), options_(options), sink_(sink) {}
  void begin(const RecordLayout& layout) override {
    if (gravity_ && *gravity_ != "none") {
      const bool is_turned = gravity_->starts_with('-');
      const std::string axis = gravity_->substr(is_turned ? 1 : 0);
      const auto found =
          std::find_if(layout.axes.begin(), layout.axes.end(), [&](const AxisColumn& each) { return axis == std::string(1, each.axis); });
      if (found == layout.axes.end()) throw UsageError("--gravity '" + *gravity_ + "': give an axis of the record, such as z or -z");
      conditioning_.offset[static_cast<std::size_t>(found - layout.axes.begin())] = is_turned ? -k_gravity : k_gravity;
    }
    if (options_.resample) {
      conditioning_.rate = number_of(options_.resample, "--resample", 0.0, ", in Hz");
      if (*conditioning_.rate < layout.time.rate * (1.0 - 1e-9))
        throw UsageError("--resample " + *options_.resample + ": the record has " + rounded_text(layout.time.rate) +
                         " Hz; fewer samples would fold high frequencies into low ones. Keep the rate, and filter with --cfc");
      if (*conditioning_.rate > k_most_resampling * layout.time.rate)
        throw UsageError("--resample " + *options_.resample + ": at most " + rounded_text(k_most_resampling) + " times the record's " +
                         rounded_text(layout.time.rate) + " Hz");
    }
    conditioner_.emplace(conditioning_, sink_);
    conditioner_->begin(layout);
  }
  void begin_segment(std::size_t line) override { conditioner_->begin_segment(line); }
  void put(double t, const double* a) override { conditioner_->put(t, a); }
  void end_segment() override { conditioner_->end_segment(); }
  [[nodiscard]] const Conditioner& conditioner() const { return *conditioner_; }
  [[nodiscard]] const Conditioning& conditioning() const { return conditioning_; }

private:
  Conditioning conditioning_;
  std::optional<std::string> gravity_;
  const RecordOptions& options_;
  SignalSink& sink_;
  std::optional<Conditioner> conditioner_;
};

std::string in_g(double a) { return std::isnan(a) ? "-" : rounded_text(a / k_gravity, 3); }

void print_events(std::ostream& out, const RecordResult& result) {
  const RecordLayout& layout = result.recording.layout;
  TextTable table(
      {Align::right, Align::left, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"event", "axis", "time s", "peak g", "to 100 Hz", "to 17 Hz", "lasts ms", "dv m/s", "freq. Hz"});
  std::vector<const ShockEvent*> order;
  for (const EventResult& found : result.events) order.push_back(&found.event);
  const auto size = [](const ShockEvent* e) { return std::abs(e->axes[e->worst].peak); };
  if (order.size() > k_shown_events) { // shows the largest events in order of time
    std::partial_sort(order.begin(), order.begin() + k_shown_events, order.end(),
                      [&](const auto* a, const auto* b) { return size(a) > size(b); });
    order.resize(k_shown_events);
    std::sort(order.begin(), order.end(), [](const auto* a, const auto* b) { return a->number < b->number; });
  }
  for (const ShockEvent* event : order) {
    const AxisEvent& axis = event->axes[event->worst];
    table.add_row({std::to_string(event->number) + (event->goes_on ? "+" : ""), std::string(1, layout.axes[event->worst].axis),
                   rounded_text(axis.peak_time, 7), in_g(axis.peak), in_g(axis.at_cfc60), in_g(axis.at_cfc10),
                   rounded_text(1e3 * axis.duration, 3), rounded_text(axis.velocity_change, 3), rounded_text(axis.frequency, 3)});
  }
  out << "\n"
      << counted(result.events.size(), "event", "events") << " beyond " << in_g(result.rules.threshold) << " g, peaks up to "
      << rounded_text(result.bandwidth, 3) << " Hz"
      << (order.size() < result.events.size() ? "; the " + std::to_string(order.size()) + " greatest:"
          : order.empty()                     ? ""
                                              : ":")
      << "\n";
  if (!order.empty()) out << table;
}

void print_peaks(std::ostream& out, const RecordResult& result) {
  TextTable table({Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right, Align::right});
  table.add_row({"entry", "time s", "x g", "y g", "z g", "peak g", "lasts ms", "dv m/s"});
  std::size_t number = 0;
  for (const PeakEntry& e : result.recording.peaks) {
    if (++number > k_shown_events) break;
    table.add_row({std::to_string(number), rounded_text(e.t, 7), in_g(e.axis[0]), in_g(e.axis[1]), in_g(e.axis[2]), in_g(e.magnitude),
                   std::isnan(e.duration) ? "-" : rounded_text(1e3 * e.duration, 3),
                   std::isnan(e.velocity_change) ? "-" : rounded_text(e.velocity_change, 3)});
  }
  out << "\n" << table;
  if (number > k_shown_events) out << "  ... " << result.recording.peaks.size() - k_shown_events << " more; -o DIR writes all\n";
}

void print_result(std::ostream& out, const RecordResult& result, const std::optional<std::string>& no_events_because) {
  const RecordLayout& layout = result.recording.layout;
  out << layout.file << "\n";
  for (const std::string& line : facts_text(result.recording)) out << "  " << line << "\n";
  if (layout.is_peaks) return print_peaks(out, result);
  if (result.interpolated > 0)
    out << "  " << result.interpolated << " samples lie between those of the record: it was resampled at " << rounded_text(result.rate)
        << " Hz.\n";
  if (result.conditioning.high_pass)
    out << "  high-pass: what is slower than " << rounded_text(*result.conditioning.high_pass) << " Hz was taken away, as asked.\n";
  if (!result.conditioning.segment_offsets.empty()) {
    out << "  drift: of each segment a constant was taken away, as asked; of the first";
    for (std::size_t i = 0; i < layout.axes.size(); ++i)
      out << (i > 0 ? ", " : " ") << layout.axes[i].axis << " "
          << rounded_text(result.conditioning.segment_offsets.front()[i] / k_gravity, 3) << " g";
    out << ".\n";
  }
  out << "  drift: driven by this acceleration alone, a base would after " << rounded_text(result.drift.duration, 4) << " s have";
  for (std::size_t i = 0; i < layout.axes.size(); ++i)
    out << (i > 0 ? "; " : " ") << layout.axes[i].axis << " " << rounded_text(result.drift.velocity[i], 3) << " m/s, "
        << rounded_text(result.drift.displacement[i], 3) << " m";
  out << "\n";
  if (no_events_because) out << "\nEvents are not listed: " << *no_events_because << ".\n";
  else print_events(out, result);
}

// Ignores the signal. Used where only the results of the preceding Conditioner are needed.
class DiscardingSink : public SignalSink {
public:
  void begin(const RecordLayout&, double) override {}
  void begin_segment(std::size_t) override {}
  void put(double, const double*, const double*) override {}
  void end_segment() override {}
};

// Returns the mean acceleration of each segment. This requires reading the file a first time.
std::vector<std::array<double, 3>> means_of(const std::string& file, const RecordOptions& options, const Conditioning& conditioning) {
  if (is_standard_input(file)) throw UsageError("--drift line of a whole signal needs a file that can be read twice, not standard input");
  DiscardingSink nowhere;
  GravityFirst first(conditioning, options.gravity, options, nowhere);
  LineSource source(file);
  const Recording recording = read_record(source, read_options(options), first);
  if (recording.layout.is_peaks) throw UsageError("--drift: '" + file + "' holds peaks, no signal");
  return first.conditioner().segment_means();
}

// Returns an error if the mean reading at rest exceeds half the threshold on any axis: gravity would then trigger the event search.
std::optional<std::string> gravity_problem(const RecordOptions& options, const RecordResult& result) {
  constexpr double k_felt = 0.5;
  if (options.gravity || options.quiet || result.recording.layout.is_peaks) return {};
  for (std::size_t i = 0; i < result.recording.layout.axes.size(); ++i) {
    const double rest = result.recording.facts.axes[i].rest;
    if (std::abs(rest) < k_felt * result.rules.threshold) continue;
    const std::string axis = std::string(rest < 0.0 ? "-" : "") + result.recording.layout.axes[i].axis;
    return "axis " + axis + " reads " + in_g(std::abs(rest)) + " g at rest, which counts towards the threshold of " +
           in_g(result.rules.threshold) + " g. Say --gravity " + axis + " to subtract it, or --gravity none to keep it";
  }
  return {};
}

struct Outputs {
  std::string folder;    ///< output folder; "": none
  std::size_t event = 0; ///< number of the event whose samples are written; 0: all events
  DriftCorrection drift = DriftCorrection::none;
};

void write_tables(const RecordResult& result, const Outputs& outputs) {
  write_file(outputs.folder + "/events.csv", record_events_csv(result));
  if (!result.recording.layout.is_peaks) write_file(outputs.folder + "/shock_spectra.csv", spectra_csv(result));
  write_file(outputs.folder + "/record.json", record_json(result));
}

void process(const std::string& file, const RecordOptions& options, const Outputs& outputs, Console& console) {
  ReadOptions reading = read_options(options);
  if (options.quiet) reading.rest = rest_stretch(*options.quiet);
  RecordResult result;
  result.rules = event_rules(options);
  Conditioning conditioning;
  if (options.cfc) conditioning.frequency_class = number_of(options.cfc, "--cfc", 0.0, ", in Hz");
  if (options.high_pass) conditioning.high_pass = number_of(options.high_pass, "--high-pass", 0.0, ", in Hz");
  if (options.quiet) conditioning.offset = quiet_offset(file, *options.quiet, reading);
  if (outputs.drift == DriftCorrection::line && outputs.event == 0) conditioning.segment_offsets = means_of(file, options, conditioning);
  std::optional<std::string> window;
  const RecordLayout* layout = nullptr;
  EventPictures pictures;
  ShockFinder finder(result.rules, [&](const ShockEvent& event, const Window& samples) {
    EventResult found{event, {}};
    for (std::size_t i = 0; i < event.axes.size() && !outputs.folder.empty(); ++i)
      found.spectra.push_back(shock_spectrum(samples.filtered[i], samples.rate));
    if (event.number == outputs.event) window = window_csv(samples, *layout, outputs.drift);
    if (!outputs.folder.empty()) pictures.add(event, samples, found.spectra);
    result.events.push_back(std::move(found));
  });
  SignalWriter writer(outputs.folder, false);
  const bool writes_signal = !outputs.folder.empty() && outputs.event == 0;
  Tee tee(finder, writes_signal ? &writer : nullptr);
  struct LayoutRecorder : GravityFirst {
    using GravityFirst::GravityFirst;
    const RecordLayout** at = nullptr;
    void begin(const RecordLayout& seen) override {
      *at = &seen;
      GravityFirst::begin(seen);
    }
  } first(conditioning, options.gravity, options, tee);
  first.at = &layout;
  LineSource source(file);
  result.recording = read_record(source, reading, first);
  result.conditioning = first.conditioning();
  if (!result.recording.layout.is_peaks) {
    result.rate = first.conditioner().rate();
    result.bandwidth = first.conditioner().bandwidth();
    result.interpolated = first.conditioner().interpolated();
    result.drift = first.conditioner().drift();
  }
  const std::optional<std::string> no_events = gravity_problem(options, result);
  if (no_events && (options.is_json || !outputs.folder.empty())) throw UsageError("'" + file + "': " + *no_events);
  if (outputs.event > 0 && !window)
    throw UsageError("--event " + std::to_string(outputs.event) + ": the record has " + counted(result.events.size(), "event", "events") +
                     " beyond the threshold");
  if (console.verbosity != Verbosity::quiet && !options.is_json) print_result(console.out, result, no_events);
  if (options.is_json) console.out << record_json(result);
  if (outputs.folder.empty()) return;
  write_tables(result, outputs);
  if (const std::string picture = pictures.svg(result.recording.layout, result.bandwidth); !picture.empty())
    write_file(outputs.folder + "/events.svg", picture);
  if (window) write_file(outputs.folder + "/event_" + std::to_string(outputs.event) + ".csv", *window);
  static_cast<void>(writer.commit());
}

// Returns one output folder for each file; for several files each folder is named after its file.
std::vector<std::unique_ptr<RecordFolder>> result_folders(const RecordOptions& options) {
  std::vector<std::unique_ptr<RecordFolder>> folders;
  for (const std::string& file : options.files) {
    const std::string path = options.files.size() > 1 ? (fs::path(*options.output) / fs::path(file).stem()).string() : *options.output;
    for (const auto& other : folders)
      if (fs::path(other->path()) == fs::path(path).lexically_normal())
        throw UsageError("-o: two of the files have the name '" + fs::path(file).stem().string() +
                         "', so that their results would have the same folder. Read them one by one");
    folders.push_back(std::make_unique<RecordFolder>(path, options.is_overwriting));
  }
  return folders;
}

void commit(RecordFolder& folder, bool is_silent, Console& console) {
  const std::vector<std::string> written = folder.commit();
  if (is_silent) return;
  console.out << "\nWritten to " << folder.path() << ": ";
  for (std::size_t i = 0; i < written.size() && i < 6; ++i) console.out << (i > 0 ? ", " : "") << written[i];
  console.out << (written.size() > 6 ? ", ..." : "") << "\n";
}

ExitCode make(const RecordOptions& options, Console& console) {
  std::string known;
  bool is_known = false;
  for (const RecordKind& kind : record_kinds()) {
    known += (known.empty() ? "" : ", ") + kind.name;
    is_known |= kind.name == *options.make;
  }
  if (!is_known) throw UsageError("--make '" + *options.make + "': give one of " + known);
  if (options.files.size() != 1) throw UsageError("--make: name one file to write");
  const OutputFiles files(console, {{"FILE", options.files.front()}}, options.is_overwriting);
  files.write(options.files.front(), make_record(*options.make));
  if (files.may_print()) console.out << "Written to " << options.files.front() << "\n";
  return ExitCode::done;
}

ExitCode record(const RecordOptions& options, Console& console) {
  if (options.make) return make(options, console);
  Outputs outputs;
  if (options.quiet && options.gravity)
    throw UsageError("--rest takes away all that is there at rest, gravity included: leave --gravity out");
  if (options.drift) outputs.drift = choice(*options.drift, "--drift", k_drifts);
  if (options.event) outputs.event = static_cast<std::size_t>(std::floor(number_of(options.event, "--event", 0.0)));
  if (options.event && std::to_string(outputs.event) != *options.event)
    throw UsageError("--event '" + *options.event + "': give the number of an event, from 1");
  if (options.event && !options.output) throw UsageError("--event writes the window of one event: say where with -o DIR");
  if (outputs.drift != DriftCorrection::none && options.high_pass)
    throw UsageError("--high-pass leaves no drift for --drift: give one of them");
  const bool is_silent = console.verbosity == Verbosity::quiet || options.is_json;
  std::vector<std::unique_ptr<RecordFolder>> folders;
  if (options.output) folders = result_folders(options);
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    if (i > 0 && !is_silent) console.out << "\n";
    if (options.output) outputs.folder = folders[i]->staging();
    process(options.files[i], options, outputs, console);
  }
  for (const auto& folder : folders) commit(*folder, is_silent, console); // only if every file has been read without error
  return ExitCode::done;
}

} // namespace

Command record_command() {
  const auto o = std::make_shared<RecordOptions>();
  Command command;
  command.name = "record";
  command.summary = "a shock recorder's file: what it holds, its events, signals for a model";
  command.examples = R"(  steplap record --make endaq shock.csv
  steplap record shock.csv --gravity z --cfc 60
  steplap record shock.csv --gravity z --event 1 -o out/shock
What cannot be known from the file is asked for, with the option that settles it: docs/how-to/read_a_record.md.
)";
  command.options = {
      {"FILE", &o->files, "FILE", "recorder's files (CSV); - is standard input", true},
      {"-o,--output", &o->output, "DIR", "write the cleaned signal, events and shock spectra there"},
      {"--event", &o->event, "N", "with -o: write the window of event N, times from 0, instead of the whole signal"},
      {"--json", &o->is_json, "", "print the result as JSON"},
      {"-f,--force", &o->is_overwriting, "", "overwrite earlier files"},
      {"--make", &o->make, "KIND",
       "write a synthetic record to FILE: gcdc, gcdc-epoch, phone, palt, shocklog, monilog, msr, lansmont, solve, endaq"},
      {"--drift", &o->drift, "HOW",
       "of the signal, or with --event of its window: none (default), or line: less a constant, so that velocity ends where it began"},
      {"--high-pass", &o->high_pass, "HZ", "take away what is slower, without phase shift"}};
  const std::vector<Option> reading = reading_options(*o);
  command.options.insert(command.options.end() - 2, reading.begin(), reading.end());
  command.run = [o](Console& console) { return record(*o, console); };
  return command;
}

} // namespace steplap
