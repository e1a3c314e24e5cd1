// A sub-command of `steplap`: its options as data, and what it does.
//
// A command knows nothing of the parser (command_line.cpp does). Adding a sub-command = one file pair
// with a function that returns its Command + one line in commands.cpp.
#pragma once

#include "tools/steplap/console.h"

#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace steplap {

enum class ExitCode : int {
  done = 0,
  internal_error = 1,    ///< a fault of the program itself
  usage = 2,             ///< wrong command line, or results that cannot be written
  model_error = 3,       ///< the model cannot be used as it stands
  numerical_failure = 4, ///< the computation could not be finished
  criterion_failed = 5,  ///< finished, but a criterion that was asked for is not met
  inspect = 10,          ///< an assessment's decision
  send_back = 11,        ///< the same: return
  open = 12              ///< the same: what is needed to decide is not known
};

/// What the user asked for cannot be done as asked. Exit code 2.
class UsageError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// Where the value of an option goes; the pointee must live as long as the Command.
using OptionTarget = std::variant<bool*, std::string*, std::optional<std::string>*, std::vector<std::string>*>;

struct Option {
  std::string names; ///< "-o,--output"; without a dash: a positional argument
  OptionTarget target;
  std::string value_name; ///< what help calls the value: "DIR"
  std::string doc;
  bool is_required = false;
};

/// An option that there was once.
struct RetiredOption {
  std::string name;   ///< "--threads"
  std::string advice; ///< what to do without it
};

struct Command {
  std::string name;
  std::string summary;  ///< one line
  std::string examples; ///< shown after the options, lines end with \n
  std::vector<Option> options;
  std::function<ExitCode(Console& console)> run;
  std::vector<RetiredOption> retired{};
  bool prints_tables = false; ///< it has --json (json_screen.h)
};

} // namespace steplap
