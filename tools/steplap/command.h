// A sub-command of `steplap`: its options as data, and a function that runs it.
//
// Commands are independent of the parser (command_line.cpp). To add a sub-command, write one file pair with a function that returns its
// Command, and add one line to commands.cpp.
#pragma once

#include "tools/steplap/console.h"

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace steplap {

/// Exit codes of the program.
enum class ExitCode : int {
  done = 0,
  internal_error = 1,    ///< an error in the program itself
  usage = 2,             ///< wrong command line, or results cannot be written
  model_error = 3,       ///< the model is invalid
  numerical_failure = 4, ///< the computation failed
  criterion_failed = 5,  ///< completed, but a criterion is not met
  inspect = 10,          ///< decision of an assessment
  send_back = 11,        ///< decision "return" of an assessment
  open = 12              ///< decision "open" of an assessment: necessary information is missing
};

/// Thrown for invalid command-line arguments. Exit code 2.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Destination of an option's value. The pointee must live as long as the Command.
using OptionTarget = std::variant<bool*, std::string*, std::optional<std::string>*, std::vector<std::string>*>;

/// An option or positional argument.
struct Option {
  std::string names; ///< "-o,--output"; a name without dashes is a positional argument
  OptionTarget target;
  std::string value_name; ///< name of the value in the help: "DIR"
  std::string doc;
  bool is_required = false;
};

/// An option that no longer exists.
struct RetiredOption {
  std::string name;   ///< former option, "--threads"
  std::string advice; ///< replacement, shown to the user
};

/// A sub-command.
struct Command {
  std::string name;
  std::string summary;  ///< description in the list of commands, one line
  std::string examples; ///< shown after the options; lines end with \n
  std::vector<Option> options;
  std::function<ExitCode(Console& console)> run;
  std::vector<RetiredOption> retired{};
  bool prints_tables = false; ///< true if the command has the option --json (json_screen.h)
};

} // namespace steplap
