#include "tools/steplap/commands.h"

#include <memory>

namespace steplap {

Command help_command() {
  const auto name = std::make_shared<std::string>();
  Command command;
  command.name = "help";
  command.summary = "what a command does and its options, as COMMAND --help; with --json of all commands, for programs";
  command.examples = "  steplap help simulate\n  steplap help --json\n";
  command.options = {{"COMMAND", name.get(), "COMMAND", "a command (default: the list of them)"}};
  command.prints_tables = true;
  command.run = [name](Console&) { return ExitCode::done; };
  return command;
}

} // namespace steplap
