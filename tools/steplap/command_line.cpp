#include "tools/steplap/command_line.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/atomic_file.h"
#include "mbd/run/result_files.h"
#include "mbd/run/version.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/json_screen.h"
#include "tools/steplap/licences.h"
#include "tools/steplap/log.h"
#include "tools/steplap/output_files.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <ostream>

namespace steplap {

namespace {

constexpr const char* k_exit_codes = R"(Exit codes:
  0  done
  1  a fault of the program itself
  2  wrong command line, or results that cannot be written
  3  the model cannot be used as it stands
  4  the computation could not be finished (what there is is saved as partial_*)
  5  finished, but a criterion that was asked for is not met
)";

constexpr const char* k_examples = R"(
Examples:
  steplap check my.toml
  steplap simulate my.toml -o out
  steplap simulate my.toml --set "element.front foot.stiffness=2 GN/m" --integrator dop853
  steplap elements spring_damper
"steplap help COMMAND" lists the options of a command.)";

struct BindOption {
  CLI::App& app;
  const Option& option;

  CLI::Option* operator()(bool* target) const { return app.add_flag(option.names, *target, option.doc); }
  CLI::Option* operator()(std::optional<std::string>* target) const {
    return named(app.add_option_function<std::string>(
        option.names, [target](const std::string& value) { *target = value; }, option.doc));
  }
  CLI::Option* operator()(std::string* target) const { return named(app.add_option(option.names, *target, option.doc)); }
  CLI::Option* operator()(std::vector<std::string>* target) const {
    CLI::Option* bound = named(app.add_option(option.names, *target, option.doc));
    // An option can be repeated with one value each; a positional argument takes all remaining values.
    if (option.names.front() == '-') bound->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return bound;
  }
  CLI::Option* named(CLI::Option* bound) const { return bound->type_name(option.value_name); }
};

struct CommonFlags {
  bool is_quiet = false, is_verbose = false, is_json = false;

  [[nodiscard]] Verbosity verbosity() const {
    if (is_quiet) return Verbosity::quiet;
    return is_verbose ? Verbosity::verbose : Verbosity::normal;
  }
};

// Adds a command to the parser. Options are created only if `is_meant`, because this takes longer than everything else in a short command;
// the other commands are only listed.
void bind(CLI::App& app, const Command& command, bool is_meant, CommonFlags& flags) {
  CLI::App* sub = app.add_subcommand(command.name, command.summary);
  if (!is_meant) return;
  if (!command.examples.empty()) sub->footer("Examples:\n" + command.examples);
  for (const Option& option : command.options) std::visit(BindOption{*sub, option}, option.target)->required(option.is_required);
  if (command.prints_tables) sub->add_flag("--json", flags.is_json, "print what the screen says as JSON instead, with all digits");
  CLI::Option* quiet = sub->add_flag("-q,--quiet", flags.is_quiet, "print errors only");
  sub->add_flag("-v,--verbose", flags.is_verbose, "say more about what is done")->excludes(quiet);
}

// Reports the exception that is being handled and returns the exit code. To be called in a catch block.
ExitCode report_exception(Console& console) {
  try {
    throw;
  } catch (const UsageError& error) {
    log_error(error.what());
    return ExitCode::usage;
  } catch (const ResultsInTheWay& error) {
    log_error(std::string(error.what()) + " (-o, --force)");
    return ExitCode::usage;
  } catch (const FileError& error) {
    log_error(error.what());
    return ExitCode::usage;
  } catch (const std::filesystem::filesystem_error& error) { // for example: the current folder no longer exists
    log_error("cannot use '" + error.path1().string() + "': " + error.code().message());
    return ExitCode::usage;
  } catch (const ModelError& error) {
    console.err << error.what() << "\n";
    return ExitCode::model_error;
  } catch (const NumericalFailure& error) {
    log_error(error.what());
    return ExitCode::numerical_failure;
  } catch (const std::exception& error) {
    log_error(std::string("internal error, please report it: ") + error.what());
    return ExitCode::internal_error;
  }
}

// Returns advice for the first argument that is a retired option of the command; "" if there is none.
std::string advice_on_retired(const std::vector<std::string>& arguments, const std::vector<Command>& commands) {
  if (arguments.empty()) return "";
  const auto command = std::find_if(commands.begin(), commands.end(), [&](const Command& c) { return c.name == arguments.front(); });
  if (command == commands.end()) return "";
  for (const RetiredOption& option : command->retired)
    for (const std::string& argument : arguments)
      if (argument == option.name || argument.starts_with(option.name + "=")) return option.advice;
  return "";
}

ExitCode run_command(const Program& program, const Command& command, const CommonFlags& flags, Console console) {
  try {
    refuse_wrong_streams(command);
    if (!flags.is_json) return command.run(console);
    JsonScreen screen;
    Console recorded{screen, console.err, console.is_terminal, Verbosity::normal};
    const ExitCode code = command.run(recorded);
    console.out << screen.document(program.name, command.name, static_cast<int>(code));
    return code;
  } catch (...) {
    return report_exception(console);
  }
}

bool is_given(const std::vector<std::string>& arguments, const std::string& word) {
  return std::find(arguments.begin(), arguments.end(), word) != arguments.end();
}

// Returns a hint such as " (did you mean '--report'?)" for the first argument that is similar to an option of the command; "" if there is
// none.
std::string meant_option(const std::vector<std::string>& arguments, const CLI::App& app) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (const std::string& argument : arguments) {
    const std::string name = argument.substr(0, argument.find('='));
    if (name.starts_with("--") && std::find(known.begin(), known.end(), name) == known.end()) return did_you_mean(name, known);
  }
  return "";
}

// Reports an error of the parser with the most similar sub-command. Without any arguments the list of commands is shown.
ExitCode report_usage(const CLI::ParseError& error, const std::vector<std::string>& arguments, const Program& program, CLI::App& app,
                      std::ostream& err) {
  if (arguments.empty()) {
    err << app.help();
    return ExitCode::usage;
  }
  const std::string& first = arguments.front();
  const bool is_option = first.starts_with('-');
  if (!is_option && !is_command(program, first)) {
    std::vector<std::string> names;
    for (const Command& command : program.commands) names.push_back(command.name);
    const bool is_model = first.ends_with(".toml") && is_command(program, "simulate");
    log_error("there is no command '" + first + "'" +
              (is_model ? "; to run this model: " + program.name + " simulate " + first : did_you_mean(first, names)) + "; see " +
              program.name + " --help");
    return ExitCode::usage;
  }
  if (const std::string advice = advice_on_retired(arguments, program.commands); !advice.empty()) {
    log_error(advice);
    return ExitCode::usage;
  }
  log_error(std::string(error.what()) + meant_option(arguments, is_option ? app : *app.get_subcommand(first)) + "; see " + program.name +
            " " + (is_option ? "" : first + " ") + "--help");
  if (arguments.size() == 1 && !is_option) err << "\n" << app.get_subcommand(first)->help(program.name);
  return ExitCode::usage;
}

// Returns the options of the parser as JSON, for completion scripts and man pages.
OrderedJson options_json(const CLI::App& app) {
  OrderedJson options = OrderedJson::array();
  for (const CLI::Option* option : app.get_options()) {
    OrderedJson names = OrderedJson::array();
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const bool is_positional = option->get_positional();
    if (is_positional) names.push_back(option->get_name(true));
    const bool is_flag = !is_positional && option->get_expected_max() == 0;
    options.push_back(
        {{"names", std::move(names)},
         {"takes", is_flag ? "" : option->get_type_name()},
         {"is_positional", is_positional},
         {"is_required", option->get_required()},
         {"may_be_repeated", option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll || option->get_expected_max() > 1},
         {"meaning", option->get_description()}});
  }
  return options;
}

// Returns the help of the program and of every command as JSON.
OrderedJson help_json(const Program& program, const CLI::App& app, const std::string& exit_codes) {
  OrderedJson commands = OrderedJson::array();
  for (const Command& command : program.commands)
    commands.push_back({{"name", command.name},
                        {"summary", command.summary},
                        {"examples", command.examples},
                        {"options", options_json(*app.get_subcommand(command.name))}});
  OrderedJson json = OrderedJson::object();
  json["program"] = program.name;
  json["version"] = k_version;
  json["summary"] = program.doc;
  json["options"] = options_json(app);
  json["commands"] = std::move(commands);
  json["exit_codes"] = exit_codes;
  return json;
}

OrderedJson version_json(const Program& program) {
  OrderedJson json = OrderedJson::object();
  json["program"] = program.name;
  json["version"] = k_version;
  json["compiler"] = __VERSION__;
  return json;
}

// Returns the arguments with "help check" replaced by "check --help".
std::vector<std::string> without_help_command(const Program& program, std::vector<std::string> arguments) {
  if (arguments.empty() || arguments.front() != "help" || (arguments.size() > 1 && arguments[1].starts_with('-'))) return arguments;
  arguments.erase(arguments.begin());
  if (arguments.empty() || is_command(program, arguments.front())) arguments.emplace_back("--help"); // otherwise the command does not exist
  return arguments;
}

} // namespace

bool is_command(const Program& program, const std::string& word) {
  return std::any_of(program.commands.begin(), program.commands.end(), [&word](const Command& command) { return command.name == word; });
}

int run_program(const Program& program, const std::vector<std::string>& given, std::ostream& out, std::ostream& err, bool is_terminal) {
  Console console{out, err, is_terminal};
  start_log(err, is_terminal);
  const bool is_json = is_given(given, "--json"), is_help_in_json = is_json && given.front() == "help";
  if (is_json && given.size() == 2 && is_given(given, "--version")) {
    out << version_json(program).dump(2) << "\n";
    return static_cast<int>(ExitCode::done);
  }
  const std::vector<std::string> arguments = is_help_in_json ? given : without_help_command(program, given);
  CLI::App app(program.name + ": " + program.doc, program.name);
  CommonFlags flags;
  app.set_version_flag("--version", program.name + " " + k_version, "Print the version; with --json more of it");
  app.add_flag_callback(
         "--licences", [] { throw CLI::CallForVersion(std::string(k_licences), 0); },
         "Print the licence, and those of all parts made by others")
      ->configurable(false);
  app.require_subcommand(1);
  const std::string exit_codes = program.exit_codes.empty() ? k_exit_codes : program.exit_codes;
  app.footer(exit_codes + (program.name == "steplap" ? k_examples : ""));
  for (const Command& command : program.commands) bind(app, command, is_help_in_json || is_given(arguments, command.name), flags);
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return static_cast<int>(report_usage(error, arguments, program, app, err));
    app.exit(error, out, err); // prints help or version
    return static_cast<int>(ExitCode::done);
  }
  if (is_help_in_json) {
    out << help_json(program, app, exit_codes).dump(2) << "\n";
    return static_cast<int>(ExitCode::done);
  }
  console.verbosity = flags.verbosity();
  set_log_level(console.verbosity);
  const std::string chosen = app.get_subcommands().front()->get_name();
  for (const Command& command : program.commands)
    if (command.name == chosen) return static_cast<int>(run_command(program, command, flags, console));
  return static_cast<int>(ExitCode::internal_error);
}

int code_of_output(std::ostream& out, std::ostream& err, int code) {
  errno = 0;
  out.flush();
  if (out) return code;
  err << "steplap: error: cannot write to the standard output" << (errno != 0 ? std::string(": ") + std::strerror(errno) : "") << "\n";
  return code == 0 ? static_cast<int>(ExitCode::usage) : code;
}

int run_command_line(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err, bool is_terminal) {
  return run_program({"steplap", "planar multibody dynamics with honest friction, machines described in TOML", all_commands()}, arguments,
                     out, err, is_terminal);
}

} // namespace steplap
