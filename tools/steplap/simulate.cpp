#include "tools/steplap/commands.h"

#include "mbd/base/budget.h"
#include "mbd/base/shown_text.h"
#include "mbd/io/units.h"
#include "mbd/model/validate.h"
#include "mbd/run/findings.h"
#include "mbd/run/quantity_text.h"
#include "mbd/run/report.h"
#include "mbd/run/result_files.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/json_screen.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"
#include "tools/steplap/overview_screen.h"
#include "tools/steplap/progress.h"
#include "tools/steplap/report.h"
#include "tools/steplap/required_hold.h"
#include "tools/steplap/run_screen.h"
#include "tools/steplap/shown_run.h"
#include "transformer/program.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <string_view>

namespace steplap {

namespace {

struct SimulateOptions {
  std::vector<std::string> models;
  std::vector<std::string> overrides;
  std::string output = "out";
  std::optional<std::string> end, step, integrator, tolerance, output_step, digits, time_limit, memory_limit;
  bool is_overwriting = false, is_error_estimated = false, is_estimate_left_out = false, is_reported = false, is_hold_required = false,
       has_all_extremes = false;

  /// Returns the values of --set and of its short forms.
  [[nodiscard]] std::vector<std::string> all_overrides() const {
    std::vector<std::string> all = overrides;
    if (end) all.push_back("simulation.end=" + *end);
    if (step) all.push_back("simulation.step=" + *step);
    if (integrator) all.push_back("simulation.integrator=" + *integrator);
    if (tolerance) all.push_back("simulation.tolerance=" + *tolerance);
    if (output_step) all.push_back("output.step=" + *output_step);
    if (has_all_extremes) all.emplace_back("output.channels=[\"*\"]");
    return all;
  }

  /// --time-limit and --memory-limit.
  [[nodiscard]] Budget budget() const;
  /// Returns the number of digits on the screen.
  [[nodiscard]] ShownDigits shown_digits() const {
    constexpr int k_most = 15;
    if (!digits) return {};
    if (*digits == "full") return {.is_full = true};
    int count = 0;
    const char* const end_of_text = digits->data() + digits->size();
    const auto [last, error] = std::from_chars(digits->data(), end_of_text, count);
    if (error != std::errc() || last != end_of_text || count < 1 || count > k_most)
      throw UsageError("--digits takes a whole number from 1 to " + std::to_string(k_most) + ", or full, not '" + *digits + "'");
    return {.most = count + 1}; // one more, because a leading digit 1 is not counted
  }

  /// Returns true if only the trajectory is written, to the standard output.
  [[nodiscard]] bool is_streamed() const { return is_standard_output(output); }
  [[nodiscard]] std::string folder_of(const LoadedModel& loaded) const { return (std::filesystem::path(output) / loaded.name).string(); }
};

// Reads "90" or "1.5 min".
double seconds_of(const std::string& text, const char* option) {
  const bool is_plain = text.find_first_not_of("0123456789.+-eE") == std::string::npos;
  const Quantity time = parse_quantity(is_plain ? text + " s" : text, "s");
  if (!time.problem.empty() || !(time.value > 0.0))
    throw UsageError(std::string(option) + " '" + text + "': give a time above zero, such as 90 or \"2 min\"");
  return time.value;
}

// Reads "2GB" or "500 MB".
double bytes_of(const std::string& text, const char* option) {
  static const std::map<std::string_view, double> k_units = {
      {"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"MiB", 1048576.0}, {"GiB", 1073741824.0}};
  double count = 0.0;
  const char* const end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, count);
  rest = std::find_if(rest, end, [](char c) { return c != ' '; });
  const auto unit = k_units.find(std::string_view(rest, end));
  if (error != std::errc() || !(count > 0.0) || unit == k_units.end())
    throw UsageError(std::string(option) + " '" + text + "': give a size above zero with its unit, such as 2GB or 500MB");
  return count * unit->second;
}

Budget SimulateOptions::budget() const {
  Budget budget;
  if (time_limit) budget.time = seconds_of(*time_limit, "--time-limit");
  if (memory_limit) budget.memory = bytes_of(*memory_limit, "--memory-limit");
  return budget;
}

/// A finished run and the folder of its files.
struct FinishedRun {
  Report report;
  std::string folder;
};

using Models = std::vector<std::shared_ptr<const LoadedModel>>;

// Writes one page for all runs: in the folder of a single run, or next to the folders of several.
std::string page_of(const SimulateOptions& options, const Models& models) {
  const std::filesystem::path place = models.size() == 1 ? options.folder_of(*models.front()) : options.output;
  return (place / "report.html").string();
}

void check_folders(const SimulateOptions& options, const Models& models) {
  if (options.is_streamed()) {
    if (models.size() > 1)
      throw UsageError("-o -: the standard output can hold the trajectory of one model only, not of " + std::to_string(models.size()));
    if (options.is_reported) throw UsageError("-o - writes no folder that --report could make its page of: name a folder");
    return;
  }
  std::set<std::string> folders;
  for (const auto& loaded : models) {
    const std::string folder = options.folder_of(*loaded);
    if (!folders.insert(folder).second)
      throw UsageError("two models are called '" + loaded->name + "' and would be written to the same folder, '" + folder +
                       "': run them one after the other with different -o");
    check_result_folder(folder, options.is_overwriting);
  }
  if (options.is_reported && !options.is_overwriting && std::filesystem::exists(page_of(options, models)))
    throw UsageError("'" + page_of(options, models) + "' is there already: choose another folder with -o, or " +
                     "overwrite it with --force");
}

RunOptions run_options(const SimulateOptions& options, const LoadedModel& loaded, const StopQuestion& stop) {
  RunOptions run;
  run.estimating = options.is_estimate_left_out ? Estimating::never : options.is_error_estimated ? Estimating::always : Estimating::cheap;
  run.has_second_opinion = options.is_hold_required;
  run.stop = stop;
  run.note = [&loaded](const Finding& finding) {
    const std::string text = "'" + loaded.path + "': " + text_with_place(finding);
    if (finding.level == FindingLevel::warning) log_warning(text);
    else log_info(text);
  };
  return run;
}

void log_run(const Report& report) {
  const LoadedModel& loaded = *report.run.loaded;
  if (report.estimate.status == EstimateStatus::failed)
    log_warning("'" + loaded.path + "': the error is not known: " + report.estimate.reason);
  for (const Event& event : report.run.result.events)
    log_detail("t = " + time_text(event.t) + " s: '" + event.element + "' " + event.words());
}

FinishedRun run_one(const SimulateOptions& options, const std::shared_ptr<const LoadedModel>& loaded, const StopQuestion& stop,
                    Console& console) {
  log_detail("'" + loaded->name + "': " + counted(static_cast<std::size_t>(loaded->system->body_count() - 1), "body", "bodies") + ", " +
             counted(loaded->system->rows.size(), "constraint row", "constraint rows") + ", " +
             counted(loaded->system->frictions.size(), "joint with friction", "joints with friction"));
  RunOptions asked = run_options(options, *loaded, stop);
  std::vector<Finding> before = findings_before(*loaded);
  for (const Finding& finding : before) asked.note(finding);
  Run run;
  {
    Progress progress(console, loaded->name, loaded->model.simulation.end); // erases its line before any other message
    asked.progress = std::ref(progress);
    run = run_model(loaded, asked);
    asked.progress = nullptr;
  }
  FinishedRun finished{report_on(std::move(run), std::move(before), asked), ""};
  const Report& report = finished.report;
  log_run(report);
  if (options.is_streamed()) {
    result_files(report).front().parts([&console](std::string_view part) { console.out << part; });
    log_info("'" + loaded->path + "': the verdict is " + name_of(report.judgement.verdict));
  } else {
    finished.folder = options.folder_of(*loaded);
    report.write(finished.folder, options.is_overwriting);
  }
  if (const std::optional<Failure>& failure = report.run.failure)
    log_error("'" + loaded->path + "': " + failure->text + (failure->text.ends_with('.') ? "" : ".") +
              (options.is_streamed() ? " What was computed up to there has been written"
                                     : " What was computed up to there is in '" + finished.folder + "' as partial_*"));
  return finished;
}

void check_step(const SimulateOptions& options, const Models& models) {
  for (const auto& loaded : models) {
    const std::string& integrator = loaded->model.simulation.integrator;
    if (options.step && !has_fixed_step(integrator))
      throw UsageError("--step is for integrators of a fixed step; '" + integrator + "' of '" + loaded->path +
                       "' chooses its steps by --tolerance: add --integrator rk4");
  }
}

void show_runs(const SimulateOptions& options, const std::vector<FinishedRun>& runs, Console& console) {
  const bool is_whole = console.verbosity == Verbosity::verbose || json_screen(console.out);
  std::vector<ShownRun> shown;
  for (const FinishedRun& run : runs)
    shown.push_back(is_whole ? shown_run(run.report, run.folder) : overview_of_run(run.report, run.folder, options.shown_digits()));
  if (put_runs(console.out, shown)) return;
  if (is_whole) print_tables(console.out, shown);
  else print_overviews(console.out, shown, {.has_all_digits = options.shown_digits().is_full, .has_warnings = false}); // already in the log
}

ExitCode simulate(const SimulateOptions& options, Console& console) {
  if (options.is_error_estimated && options.is_estimate_left_out) throw UsageError("--estimate-error and --no-estimate exclude each other");
  (void)options.shown_digits();
  const OutputFiles files(console, {{"-o", options.output}});
  const Models models = load_models(options.models, options.all_overrides());
  check_step(options, models);
  check_folders(options, models);
  const InterruptionGuard guard;
  const StopQuestion stop = within(options.budget(), interruption);
  std::vector<FinishedRun> runs;
  ExitCode code = ExitCode::done;
  for (const auto& loaded : models) {
    if (const std::string why = stop(); !why.empty()) {
      log_error("'" + loaded->path + "' is not run: " + why);
      code = ExitCode::numerical_failure;
      break;
    }
    try {
      runs.push_back(run_one(options, loaded, stop, console));
      if (runs.back().report.run.failure || !stop().empty()) code = ExitCode::numerical_failure;
    } catch (const NumericalFailure& failure) { // the run could not even start
      log_error("'" + loaded->path + "': " + failure.what());
      code = ExitCode::numerical_failure;
    }
  }
  if (runs.empty()) return code;
  if (options.is_hold_required && code == ExitCode::done) {
    std::vector<const Judgement*> judgements;
    for (const FinishedRun& run : runs) judgements.push_back(&run.report.judgement);
    code = required_hold(judgements);
  }
  if (options.is_reported) {
    std::vector<std::string> folders;
    for (const FinishedRun& run : runs) folders.push_back(run.folder);
    write_report(folders, page_of(options, models), options.is_overwriting);
  }
  if (!files.may_print()) return code;
  show_runs(options, runs, console);
  if (options.is_reported) console.out << "Report: " << page_of(options, models) << "\n";
  return code;
}

} // namespace

Command simulate_command() {
  const auto o = std::make_shared<SimulateOptions>();
  Command command;
  command.name = "simulate";
  command.summary = "run models, write their time histories, say what happened";
  command.examples = R"(  steplap simulate models/paper/no_interference.toml
  steplap simulate models/paper/*.toml -o out/paper --force
  make_model | steplap simulate - -o - | head
  steplap simulate my.toml --end "2 s" --integrator dop853 --tolerance 1e-9
  steplap simulate my.toml --set "element.front foot.stiffness=2 GN/m" --set body.tank.mass="48 t"
Each model gets a folder of its own, DIR/<name of the model file>, with trajectory.csv, events.csv, summary.json and model.toml.
The screen tells the verdict, what happened and what came nearest to its limit; with -v it has tables of all events and
extremes, of several models beside each other. steplap show tells the same later, from the folder. In files and tables all
numbers stand with their estimated error, if the estimate takes about a second of computing, or ten if a hold depends on it;
else the screen says what it would take, and what would be a hold is open. If the computation fails, or Ctrl-C (SIGINT,
SIGTERM, SIGHUP) stops it, what there is is saved as partial_* and the exit code is 4, or that of the signal.
A second Ctrl-C ends it at once.
)";
  command.options = {
      {"MODEL", &o->models, "FILE", "model files (TOML); - is the standard input", true},
      {"-o,--output", &o->output, "DIR|-",
       "folder for the results (default: out); - writes the trajectory of one model to the standard output, as CSV, and nothing else"},
      {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
      {"--end", &o->end, "T", "end of the run, s; short for --set simulation.end=T"},
      {"--output-step", &o->output_step, "H", "time between two rows of the trajectory, s; short for --set output.step=H"},
      {"--all", &o->has_all_extremes, "",
       "extremes of all channels, in scenes of more than 100 000 channels too; short for --set 'output.channels=[\"*\"]'"},
      {"--step", &o->step, "H", "step of a fixed-step integrator, s"},
      {"--integrator", &o->integrator, "NAME", "integration method; see steplap elements simulation"},
      {"--tolerance", &o->tolerance, "TOL",
       "relative tolerance of an adaptive integrator, for each step; the estimated error shows what "
       "it comes to"},
      {"--estimate-error", &o->is_error_estimated, "",
       "estimate the error of all numbers, from runs at a finer tolerance or step, however long they take; without "
       "it, where they take about a second, or ten if a hold depends on them"},
      {"--no-estimate", &o->is_estimate_left_out, "", "do not estimate the error"},
      {"--digits", &o->digits, "N|full",
       "digits of the numbers on the screen (default: 3; one more where the first is a 1), or all that are known, with their errors; "
       "files and the tables of -v always have all"},
      {"--time-limit", &o->time_limit, "T",
       "stop after this time of computing, s, for all models together: what was computed is saved as after Ctrl-C, with exit code 4"},
      {"--memory-limit", &o->memory_limit, "M", "stop in the same way when the program holds more memory than this, such as 2GB or 500MB"},
      {"--report", &o->is_reported, "", "write a page of the runs, too; see steplap report"},
      {"--require-hold", &o->is_hold_required, "",
       "exit code 5 unless the verdict on every run is hold, 4 if a second method, which is run for it, disagrees beyond both "
       "errors; see steplap elements acceptance"},
      {"-f,--force", &o->is_overwriting, "", "overwrite earlier results"}};
  command.retired = {
      {"--threads",
       "a run takes one thread: leave --threads out. Many runs side by side take all processors: steplap study, steplap assess"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return simulate(*o, console); };
  return command;
}

} // namespace steplap
