#include "tools/steplap/commands.h"

#include "mbd/base/number_text.h"
#include "mbd/io/atomic_file.h"
#include "mbd/run/prominence.h"
#include "mbd/run/run.h"
#include "mbd/trust/accuracy_study.h"
#include "mbd/trust/global_error.h"
#include "tools/steplap/accuracy_report.h"
#include "tools/steplap/log.h"
#include "tools/steplap/text_table.h"
#include "transformer/program.h"

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <ostream>
#include <set>

namespace steplap {

namespace {

namespace fs = std::filesystem;

constexpr double k_usual_budget = 5.0;      // default budget of CPU time, s
constexpr double k_steps_of_a_run = 8000.0; // number of steps assumed for a run if the model gives no step

struct AccuracyCommand {
  std::vector<std::string> models, overrides, integrators, settings, references, wanted;
  std::optional<std::string> end, repeats, cpu_limit, budget;
  std::string output = "out/accuracy";
  bool is_overwriting = false;
};

const std::vector<std::string>& known_integrators() { return SimulationSettings::fields().find("integrator")->choices; }

double number_of(const std::string& text, const std::string& option) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value > 0.0) || value > 1e9)
    throw UsageError(option + ": '" + text + "' should be a number above zero");
  return value;
}

void check_integrator(const std::string& name) {
  for (const std::string& known : known_integrators())
    if (known == name) return;
  throw UsageError("unknown integrator '" + name + "'" + did_you_mean(name, known_integrators()));
}

// Parses "dop853@1e-9", "rk4@1e-4": the number is a step for methods with constant steps.
MethodSetting setting_of(const System& system, const std::string& text, const std::string& option) {
  const std::size_t at = text.find('@');
  if (at == std::string::npos)
    throw UsageError(option + ": '" + text + "' should be INTEGRATOR@TOLERANCE, or INTEGRATOR@STEP for fixed steps");
  const std::string name = text.substr(0, at);
  check_integrator(name);
  return {name, number_of(text.substr(at + 1), option), !is_adaptive(system, name)};
}

AccuracyOptions options_for(const AccuracyCommand& command, const LoadedModel& loaded) {
  const System& system = *loaded.system;
  const SimulationSettings& s = loaded.model.simulation;
  AccuracyOptions options;
  for (const std::string& name : command.integrators) check_integrator(name);
  for (const std::string& text : command.settings) options.ladder.push_back(setting_of(system, text, "--setting"));
  if (options.ladder.empty() || !command.integrators.empty()) {
    const auto usual = usual_ladder(system, command.integrators.empty() ? known_integrators() : command.integrators,
                                    s.step.value_or(s.end / k_steps_of_a_run));
    options.ladder.insert(options.ladder.end(), usual.begin(), usual.end());
  }
  if (!command.references.empty()) {
    if (command.references.size() != 2 || command.references[0] == command.references[1])
      throw UsageError("--reference is given twice, each time another method: two that agree make a reference");
    options.first_reference = setting_of(system, command.references[0], "--reference");
    options.second_reference = setting_of(system, command.references[1], "--reference");
  }
  if (command.repeats) options.repeats = static_cast<int>(number_of(*command.repeats, "--repeats"));
  if (command.cpu_limit) options.cpu_limit = number_of(*command.cpu_limit, "--cpu-limit");
  options.budget = command.budget ? number_of(*command.budget, "--budget") : k_usual_budget;
  // A change of contact point at nearly equal angles has no well-defined time and no effect, so it is not compared.
  options.is_event_counted = is_main_event;
  options.progress = [](const std::string& text) { log_detail(text); };
  return options;
}

std::vector<double> wanted_errors(const AccuracyCommand& command) {
  std::vector<double> errors;
  for (const std::string& text : command.wanted) errors.push_back(number_of(text, "--error"));
  if (errors.empty()) errors = {1e-3, 1e-6, 1e-9};
  return errors;
}

std::vector<std::string> files_of(const AccuracyCommand& command, const LoadedModel& loaded) {
  const fs::path folder = fs::path(command.output) / loaded.name;
  return {(folder / "accuracy.csv").string(), (folder / "work_precision.svg").string()};
}

// Checks the arguments before a study that may take minutes.
void check_files(const AccuracyCommand& command, const std::vector<std::shared_ptr<const LoadedModel>>& models) {
  std::set<std::string> seen;
  for (const auto& loaded : models)
    for (const std::string& file : files_of(command, *loaded)) {
      if (!seen.insert(file).second)
        throw UsageError("two models are called '" + loaded->name + "' and would be written to the same files");
      if (!command.is_overwriting && fs::exists(file))
        throw UsageError("'" + file + "' exists already: choose another folder with -o, or overwrite it with --force");
    }
}

void write_files(const AccuracyCommand& command, const LoadedModel& loaded, const AccuracyStudy& study) {
  const std::vector<std::string> files = files_of(command, loaded);
  const fs::path folder = fs::path(files[0]).parent_path();
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder.string(), "cannot write results to '" + folder.string() + "': " + error.message());
  const IfExists if_exists = command.is_overwriting ? IfExists::replace : IfExists::refuse;
  const std::string title = loaded.model.header.title.empty() ? loaded.name : loaded.model.header.title;
  write_file(files[0], accuracy_csv(study), if_exists);
  write_file(files[1], work_precision_svg(study, title), if_exists);
}

ExitCode accuracy_of(const AccuracyCommand& command, const LoadedModel& loaded, Console& console) {
  try {
    const AccuracyOptions options = options_for(command, loaded);
    const AccuracyStudy study = study_accuracy(*loaded.system, initial_state_of(loaded), options_of(loaded.model), options);
    write_files(command, loaded, study);
    if (console.verbosity == Verbosity::quiet) return ExitCode::done;
    console.out << About{loaded.path} << loaded.name << ": t = 0 to " << number_text(loaded.model.simulation.end) << " s, compared every "
                << number_text(loaded.model.output.step) << " s\n";
    print_accuracy(console.out, study, wanted_errors(command));
    console.out << "Written to " << files_of(command, loaded)[0] << " and work_precision.svg\n";
    return ExitCode::done;
  } catch (const NumericalFailure& failure) {
    log_error("'" + loaded.path + "': " + failure.what());
    return ExitCode::numerical_failure;
  }
}

ExitCode accuracy(const AccuracyCommand& command, Console& console) {
  std::vector<std::string> overrides = command.overrides;
  if (command.end) overrides.push_back("simulation.end=" + *command.end);
  const auto models = load_models(command.models, overrides);
  check_files(command, models);
  (void)wanted_errors(command);
  ExitCode code = ExitCode::done;
  for (const auto& loaded : models)
    if (const ExitCode one = accuracy_of(command, *loaded, console); one != ExitCode::done) code = one;
  return code;
}

} // namespace

Command accuracy_command() {
  const auto o = std::make_shared<AccuracyCommand>();
  Command command;
  command.name = "accuracy";
  command.summary = "what accuracy costs: integrators and tolerances against a reference";
  command.examples = R"(  steplap accuracy models/paper/no_interference.toml
  steplap accuracy my.toml --integrator dop853 --integrator rk4 --error 1e-6
  steplap accuracy my.toml --setting dop853@1e-9 --reference dop853@1e-13 --reference tsit5@1e-12
Errors are the largest over all samples, divided by the range of the channel; the reference are two methods at
tight tolerance, and where these do not agree nothing is said. The ladder is climbed where the next rung costs least, until
the budget is spent. Each model gets DIR/<name>/accuracy.csv and
work_precision.svg.
)";
  command.options = {
      {"MODEL", &o->models, "FILE", "model files (TOML); - is the standard input", true},
      {"-o,--output", &o->output, "DIR", "folder for the results (default: out/accuracy)"},
      {"--set", &o->overrides, "PATH=VALUE", "lay a value over the model; may be repeated"},
      {"--end", &o->end, "T", "end of the runs, s"},
      {"--integrator", &o->integrators, "NAME", "only these, over the usual ladder; may be repeated"},
      {"--setting", &o->settings, "NAME@VALUE", "a further setting: a tolerance, or the step of a fixed-step method"},
      {"--reference", &o->references, "NAME@VALUE", "given twice: the two that have to agree (dop853@1e-13, tsit5@1e-13)"},
      {"--error", &o->wanted, "E", "name the cheapest setting for this error (default: 1e-3, 1e-6, 1e-9)"},
      {"--repeats", &o->repeats, "N", "runs of which the fastest counts, at most; of long ones fewer (default: 3)"},
      {"--budget", &o->budget, "S", "CPU time for all settings of a model together, s, the reference not counted (default: 5)"},
      {"--cpu-limit", &o->cpu_limit, "S", "a run that needs more CPU time is aborted, s (default: 60)"},
      {"-f,--force", &o->is_overwriting, "", "overwrite earlier results"}};
  command.prints_tables = true;
  command.run = [o](Console& console) { return accuracy(*o, console); };
  return command;
}

} // namespace steplap
