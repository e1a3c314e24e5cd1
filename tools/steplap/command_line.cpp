#include "tools/steplap/command_line.h"

#include "mbd/base/diagnostics.h"
#include "mbd/io/atomic_file.h"
#include "run/result_files.h"
#include "run/version.h"
#include "tools/steplap/commands.h"
#include "tools/steplap/licences.h"
#include "tools/steplap/log.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <cstring>
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
"steplap COMMAND --help" tells the options of a command.)";

struct BindOption {
  CLI::App& app;
  const Option& option;

  CLI::Option* operator()(bool* target) const {
    return app.add_flag(option.names, *target, option.doc);
  }
  CLI::Option* operator()(std::optional<std::string>* target) const {
    return named(app.add_option_function<std::string>(
        option.names, [target](const std::string& value) { *target = value; }, option.doc));
  }
  CLI::Option* operator()(std::string* target) const {
    return named(app.add_option(option.names, *target, option.doc));
  }
  CLI::Option* operator()(std::vector<std::string>* target) const {
    CLI::Option* bound = named(app.add_option(option.names, *target, option.doc));
    // An option may come again and again with one value each; a positional takes all that are left.
    if (option.names.front() == '-') bound->expected(1)->multi_option_policy(
        CLI::MultiOptionPolicy::TakeAll);
    return bound;
  }
  CLI::Option* named(CLI::Option* bound) const { return bound->type_name(option.value_name); }
};

struct VerbosityFlags {
  bool is_quiet = false, is_verbose = false;

  [[nodiscard]] Verbosity verbosity() const {
    if (is_quiet) return Verbosity::quiet;
    return is_verbose ? Verbosity::verbose : Verbosity::normal;
  }
};

// `is_meant`: its options are made, which takes longer than all else that a short command does; the others are there
// to be listed.
void bind(CLI::App& app, const Command& command, bool is_meant, VerbosityFlags& flags) {
  CLI::App* sub = app.add_subcommand(command.name, command.summary);
  if (!is_meant) return;
  if (!command.examples.empty()) sub->footer("Examples:\n" + command.examples);
  for (const Option& option : command.options)
    std::visit(BindOption{*sub, option}, option.target)->required(option.is_required);
  CLI::Option* quiet = sub->add_flag("-q,--quiet", flags.is_quiet, "say nothing but errors");
  sub->add_flag("-v,--verbose", flags.is_verbose, "say more about what is done")->excludes(quiet);
}

ExitCode run_command(const Command& command, Console& console) {
  try {
    return command.run(console);
  } catch (const UsageError& error) {
    log_error(error.what());
    return ExitCode::usage;
  } catch (const ResultsInTheWay& error) {
    log_error(std::string(error.what()) + " (-o, --force)");
    return ExitCode::usage;
  } catch (const FileError& error) {
    log_error(error.what());
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

// What to do without the first option among the arguments that the command has no longer; empty: there is none.
std::string advice_on_retired(const std::vector<std::string>& arguments, const std::vector<Command>& commands) {
  if (arguments.empty()) return "";
  const auto command = std::find_if(commands.begin(), commands.end(), [&](const Command& c) { return c.name == arguments.front(); });
  if (command == commands.end()) return "";
  for (const RetiredOption& option : command->retired)
    for (const std::string& argument : arguments)
      if (argument == option.name || argument.starts_with(option.name + "=")) return option.advice;
  return "";
}

// What the parser says about a wrong command line, with the nearest sub-command.
ExitCode report_usage(const CLI::ParseError& error, const std::vector<std::string>& arguments, const Program& program) {
  const std::vector<Command>& commands = program.commands;
  std::vector<std::string> names;
  for (const Command& command : commands)
    names.push_back(command.name);
  const bool is_unknown = !arguments.empty() && !arguments.front().starts_with('-') &&
                          std::find(names.begin(), names.end(), arguments.front()) == names.end();
  if (is_unknown)
    log_error("there is no command '" + arguments.front() + "'" +
              did_you_mean(arguments.front(), names) + "; see " + program.name + " --help");
  else if (const std::string advice = advice_on_retired(arguments, commands); !advice.empty())
    log_error(advice);
  else
    log_error(std::string(error.what()) + "; see " + program.name + " " +
              (arguments.empty() || arguments.front().starts_with('-') ? "" : arguments.front() + " ") +
              "--help");
  return ExitCode::usage;
}

} // namespace

int run_program(const Program& program, const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
                bool is_terminal) {
  Console console{out, err, is_terminal};
  start_log(err, is_terminal);
  CLI::App app(program.name + ": " + program.doc, program.name);
  const std::vector<Command>& commands = program.commands;
  VerbosityFlags flags;
  app.set_version_flag("--version", program.name + " " + k_version);
  app.add_flag_callback("--licences", [] { throw CLI::CallForVersion(std::string(k_licences), 0); }, "Print the licence, and those of all parts made by others")
      ->configurable(false);
  app.require_subcommand(1);
  app.footer((program.exit_codes.empty() ? k_exit_codes : program.exit_codes) + (program.name == "steplap" ? k_examples : ""));
  for (const Command& command : commands)
    bind(app, command, std::find(arguments.begin(), arguments.end(), command.name) != arguments.end(), flags);
  try {
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      return static_cast<int>(report_usage(error, arguments, program));
    app.exit(error, out, err); // help or version
    return static_cast<int>(ExitCode::done);
  }
  console.verbosity = flags.verbosity();
  set_log_level(console.verbosity);
  const std::string chosen = app.get_subcommands().front()->get_name();
  for (const Command& command : commands)
    if (command.name == chosen) return static_cast<int>(run_command(command, console));
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
  return run_program({"steplap", "planar multibody dynamics with honest friction, machines described in TOML", all_commands()}, arguments, out, err,
                     is_terminal);
}

} // namespace steplap
