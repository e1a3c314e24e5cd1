#include "tools/study/program/assess.h"

#include "mbd/base/event_kind.h"
#include "mbd/base/limits.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/run/quantity_text.h"
#include "tools/assess/assessment.h"
#include "tools/assess/assumed_pulse.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/text_table.h"
#include "tools/study/program/whole_number.h"
#include "transformer/recorder/fields.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <ostream>

namespace steplap {

namespace {

namespace fs = std::filesystem;
using namespace assess;
using Align = TextTable::Align;

constexpr std::size_t k_shown_events = 8, k_shown_reasons = 6, k_shown_sentences = 2; // limits that keep the output within thirty lines

// Creates the output folder before computations that may take hours, so that an invalid folder is reported at once. Removes the folder if
// nothing was written to it.
class OutputFolder {
public:
  explicit OutputFolder(const fs::path& path) : path_(path) {
    std::error_code error;
    is_new_ = fs::create_directories(path_, error);
    if (!error && !fs::is_directory(path_, error) && !error) error = std::make_error_code(std::errc::not_a_directory);
    if (error)
      throw FileError(path_.string(),
                      "cannot write to the folder '" + path_.string() + "': " + error.message() + ". Choose another one with -o");
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder() {
    std::error_code ignored;
    if (is_new_) fs::remove(path_, ignored); // fails if the folder contains files
  }

private:
  fs::path path_;
  bool is_new_ = false;
};

fs::path output_folder(const AssessOptions& o) { return o.output.value_or("out/assessment"); }

long number_or(const std::optional<std::string>& text, const char* option, long least, long otherwise) {
  return text ? whole_number(*text, option, least) : otherwise;
}

std::vector<Evidence> accepted_evidence(const AssessOptions& options) {
  std::vector<Evidence> accepted;
  for (const std::string& word : options.accepted) {
    std::string known;
    const std::size_t before = accepted.size();
    for (const Evidence item : all_evidence()) {
      known += (known.empty() ? "" : ", ") + std::string(name_of(item));
      if (word == name_of(item)) accepted.push_back(item);
    }
    if (accepted.size() == before) throw UsageError("--accept '" + word + "': give one of " + known);
  }
  return accepted;
}

// Takes the range of the sensor from the shipping document, unless it is given. What does not begin with a number is only printed.
void take_range(const std::string& file, AssessmentOptions& options) {
  std::optional<double>& range = options.reading.read.range;
  const bool is_given = range.has_value();
  for (const ShippedRecorder& recorder : options.shipment.recorders) {
    std::string text = recorder.range;
    for (const std::string sign : {"±", "+/-"})
      if (text.starts_with(sign)) text.erase(0, sign.size());
    const std::size_t number = text.find_first_not_of(' ');
    if (number == std::string::npos || std::string("0123456789.").find(text[number]) == std::string::npos) continue;
    const double stated = acceleration_of(text.substr(number), "--shipment: 'range'");
    constexpr double k_same = 1e-6; // two spellings of one range
    if (range && std::abs(*range - stated) > k_same * stated)
      throw UsageError("--shipment: '" + file + "' says that the sensor reads up to " + recorder.range + ", " +
                       (is_given
                            ? "but --range says otherwise: leave --range out, or correct the papers"
                            : "and of another recorder something else: say by --range how far the one of these records reads, and take "
                              "the range out of the papers"));
    range = stated;
  }
}

// Takes the range, and departure and arrival as the limits of the voyage, from the shipping document.
void take_shipment(const std::string& file, AssessmentOptions& options) {
  options.shipment = read_shipment(file);
  take_range(file, options);
  const Shipment& s = options.shipment;
  if (s.departure.empty() || s.arrival.empty()) return;
  const std::optional<Voyage> voyage = parse_voyage(s.departure + ", " + s.arrival);
  if (!voyage)
    throw UsageError("--shipment: '" + s.departure + "' and '" + s.arrival +
                     "' are no departure and arrival: give two dates with times of day, as in \"2016-01-04 10:00\", in order, both with a "
                     "zone or both without");
  if (options.voyage) throw UsageError("--voyage: '" + file + "' says when the journey began and ended: leave one of them out");
  options.voyage = voyage;
}

AssessmentOptions assessment_options(const AssessOptions& o) {
  AssessmentOptions options;
  options.reading.read = read_options(o);
  options.reading.rules = event_rules(o);
  options.reading.gravity = o.gravity;
  if (o.cfc) options.reading.frequency_class = number_of(o.cfc, "--cfc", 0.0, ", in Hz");
  if (o.resample) options.reading.rate = number_of(o.resample, "--resample", 0.0, ", in Hz");
  if (o.quiet && o.gravity) throw UsageError("--rest takes away all that is there at rest, gravity included: leave --gravity out");
  if (o.quiet) options.reading.rest = rest_stretch(*o.quiet);
  if (o.pulse) {
    options.reading.pulse = parse_assumed_pulse(*o.pulse);
    if (!options.reading.pulse)
      throw UsageError("--pulse '" + *o.pulse +
                       "': give half-sine, haversine or triangle, and the duration if the list has none: \"half-sine 50 ms\"");
  }
  if (o.pulse_axis) {
    if (!o.pulse) throw UsageError("--pulse-axis says along which axis pulses are: give --pulse, too");
    if (*o.pulse_axis != "x" && *o.pulse_axis != "y" && *o.pulse_axis != "z")
      throw UsageError("--pulse-axis '" + *o.pulse_axis + "': give x, y or z");
    options.reading.pulse->axis = o.pulse_axis->front();
  }
  options.overrides = o.overrides;
  options.second_records = o.second_records;
  options.accepted = accepted_evidence(o);
  if (o.voyage) {
    options.voyage = parse_voyage(*o.voyage);
    if (!options.voyage)
      throw UsageError(
          "--voyage '" + *o.voyage +
          "': give its begin and end, as two dates with times of day (\"2016-01-04 10:00, 2016-01-06 18:00\", both with a zone or "
          "both without) or in the record's own seconds (0,7200)");
  }
  if (o.shipment) take_shipment(*o.shipment, options);
  if (o.budget) options.budget = number_of(o.budget, "--budget", 0.0, ", in s");
  options.criteria = o.criteria.value_or("acceptance-3g");
  if (o.is_estimate_left_out) options.estimating = Estimating::never;
  options.sampling.samples = number_or(o.samples, "--samples", 0, options.sampling.samples);
  options.sampling.seed = static_cast<std::uint64_t>(number_or(o.seed, "--seed", 0, 1));
  options.sampling.threads = o.threads ? static_cast<int>(whole_number(*o.threads, "--threads", 1, k_most_threads)) : 0;
  options.sampling.store = (output_folder(o) / "samples.sqlite").string();
  options.stop = interruption;
  return options;
}

// Shows the progress in one line on a terminal.
class AssessProgress {
public:
  explicit AssessProgress(Console& console) : console_(console) {}
  AssessProgress(const AssessProgress&) = delete;
  AssessProgress& operator=(const AssessProgress&) = delete;
  ~AssessProgress() {
    if (is_shown_) console_.err << "\r\x1b[K" << std::flush;
  }
  void operator()(const std::string& what, long done, long all) {
    const auto now = std::chrono::steady_clock::now();
    if (!console_.is_terminal || console_.verbosity == Verbosity::quiet || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    is_shown_ = true;
    console_.err << "\r\x1b[K" << what << ": " << done << " of " << all << std::flush;
  }

private:
  Console& console_;
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point last_;
};

std::string percent(double share) { return rounded_text(std::round(1e3 * share) / 10.0) + " %"; }

void print_event(TextTable& table, const Assessment& a, std::size_t number) {
  const VoyageEvent& e = a.events[number];
  const RecordEvents& record = a.records[e.record];
  const ShockEvent& shock = record.events[e.event].event;
  const AxisEvent& axis = shock.axes[shock.worst];
  for (std::size_t m = 0; m < e.passages.size(); ++m) {
    const Passage& p = e.passages[m];
    const auto weakest = std::min_element(p.joints.begin(), p.joints.end(),
                                          [](const JointPassage& x, const JointPassage& y) { return x.margin < y.margin; });
    const bool slips = std::any_of(p.joints.begin(), p.joints.end(), [](const JointPassage& j) { return j.slips; });
    double slid = 0.0;
    for (const JointPassage& joint : p.joints) slid = std::max(slid, joint.slid_total);
    const char* const event = words_of(EventKind::slips);
    const bool has_joints = !p.joints.empty();
    const char* const outcome = !p.is_made ? "not run" : has_joints ? "holds" : "-";
    const bool is_first = m == 0;
    table.add_row({is_first ? std::to_string(number + 1) : "", is_first ? rounded_text(axis.peak_time, 7) : "",
                   is_first ? std::string(1, record.axes()[shock.worst]) + " " + rounded_text(axis.peak / k_gravity, 3) : "",
                   a.models[m].recorder.plane, name_of(p.verdict), slips ? event : outcome,
                   weakest == p.joints.end() ? "-" : rounded_text(weakest->margin, 3), has_joints ? quantity_text(slid, "m") : "-",
                   has_joints && m < e.slip.size() && e.slip[m].runs > 0 ? percent(e.slip[m].value) : "-"});
  }
}

// Returns the largest events, in order of time.
std::vector<std::size_t> shown_events(const Assessment& a) {
  const std::size_t most = std::max<std::size_t>(1, k_shown_events / std::max<std::size_t>(1, a.models.size()));
  std::vector<std::size_t> order(a.events.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto margin = [&](std::size_t i) {
    double least = 1e300;
    for (const Passage& p : a.events[i].passages)
      for (const JointPassage& joint : p.joints) least = std::min(least, joint.margin);
    return least;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) { return margin(x) < margin(y); });
  if (order.size() > most) order.resize(most);
  std::sort(order.begin(), order.end());
  return order;
}

// Returns the largest readings, as in "x 1.2 g, z 0.4 g".
std::string greatest_text(const RecorderFindings& found) {
  std::string text;
  for (std::size_t i = 0; i < found.greatest.size(); ++i)
    if (std::isfinite(found.greatest[i]))
      text += (text.empty() ? "" : ", ") + std::string(1, "xyz"[i]) + " " + rounded_text(found.greatest[i] / k_gravity, 3) + " g";
  return text.empty() ? "nothing" : text;
}

void print_assessment(std::ostream& out, const Assessment& a, const std::string& file) {
  out << "Decision: " << name_of(a.decision) << ". " << a.reason << "\n\n";
  for (std::size_t i = 0; i < a.reasons.size() && i < k_shown_reasons; ++i)
    out << "  " << name_of(a.reasons[i].outcome) << "  " << a.reasons[i].criterion << ": " << a.reasons[i].text << "\n";
  const std::vector<std::size_t> shown = shown_events(a);
  out << "\n"
      << counted(a.events.size(), "event", "events") << " of " << counted(a.records.size(), "record", "records")
      << (shown.size() < a.events.size() ? "; the " + std::to_string(shown.size()) + " with the least margins:"
          : shown.empty()                ? ""
                                         : ":")
      << "\n";
  TextTable table(
      {Align::right, Align::right, Align::left, Align::left, Align::left, Align::left, Align::right, Align::right, Align::right});
  table.add_row({"event", "time s", "peak g", "plane", "verdict", "joints", "margin", "slid in all", "P(slip)"});
  for (const std::size_t i : shown) print_event(table, a, i);
  if (!shown.empty()) out << table;
  if (a.damage.runs > 0)
    out << "\nProbability of damage in the voyage: " << percent(a.damage.value) << " (95 %: " << percent(a.damage.low) << " to "
        << percent(a.damage.high) << ", " << a.damage.runs << " samples).\n";
  for (std::size_t i = 0; i < a.hangs_on.size() && i < k_shown_sentences; ++i) out << a.hangs_on[i] << "\n";
  if (a.decision != Decision::energise) out << coverage_text(a.records) << "\n"; // for "energise" the first line contains it
  for (std::size_t i = 0; i < a.recorders.size(); ++i)
    out << (i == 0 ? "First" : "Second") << " recorder: " << name_of(a.recorders[i].decision) << ", "
        << counted(a.recorders[i].events, "event", "events") << ", at most " << greatest_text(a.recorders[i]) << ", least margin "
        << rounded_text(a.recorders[i].least_margin, 3) << "\n";
  for (const MissingEvidence& missing : a.missing)
    if (a.is_accepted(missing.item)) out << "Accepted (" << name_of(missing.item) << "): " << missing.reason << "\n";
  for (std::size_t i = 0; i < a.tests.size() && i < k_shown_sentences; ++i) out << (i == 0 ? "Tests: " : "  ") << a.tests[i] << "\n";
  out << "Written to " << file << "\n";
}

ExitCode code_of(Decision decision) {
  switch (decision) {
  case Decision::energise: return ExitCode::done;
  case Decision::inspect: return ExitCode::inspect;
  case Decision::send_back: return ExitCode::send_back;
  case Decision::open: break;
  }
  return ExitCode::open;
}

ExitCode print_criteria(const std::string& name, Console& console) {
  std::string known;
  for (const CriteriaPreset& preset : criteria_presets()) {
    if (preset.name == name) {
      console.out << preset.toml;
      return ExitCode::done;
    }
    known += (known.empty() ? "" : ", ") + preset.name;
  }
  throw UsageError("--print-criteria '" + name + "': give one of " + known);
}

} // namespace

ExitCode run_assessment(const AssessOptions& o, Console& console) {
  if (o.print_criteria) return print_criteria(*o.print_criteria, console);
  AssessmentOptions options = assessment_options(o);
  if (o.records.empty()) throw UsageError("name a recorder's file: steplap assess RECORD --model MODEL");
  if (o.models.empty()) throw UsageError("name a model of the machine with --model");
  if (o.plane || o.directions || o.largest)
    throw UsageError("--plane, --directions and --largest are of use with --static alone: leave them out");
  const std::string file = (output_folder(o) / "assessment.json").string();
  if (!o.is_overwriting && fs::exists(file))
    throw UsageError("'" + file + "' exists. Choose another folder with -o, or give --force to overwrite it.");
  const InterruptionGuard guard;
  const OutputFolder folder(output_folder(o));
  std::optional<Assessment> assessment;
  {
    AssessProgress progress(console);
    options.progress = std::ref(progress);
    assessment = assess::assess(o.records, o.models, options);
  }
  const std::string json = assessment_json(*assessment);
  write_file(file, json, o.is_overwriting ? IfExists::replace : IfExists::refuse);
  if (o.is_json) console.out << json;
  else if (console.verbosity != Verbosity::quiet) print_assessment(console.out, *assessment, file);
  return code_of(assessment->decision);
}

} // namespace steplap
