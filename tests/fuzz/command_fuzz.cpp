// The command line, an argument a line: parsed for all commands, none of which is run; and its --set values laid over a model.
#include "tests/fuzz/fuzz.h"

#include "mbd/io/reader.h"
#include "tools/steplap/command_line.h"
#include "tools/steplap/commands.h"
#include "transformer/catalog.h"

#include <fstream>
#include <sstream>

using namespace steplap;

namespace {

std::vector<std::string> lines_of(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> lines;
  std::istringstream text(std::string(data, data + size));
  for (std::string line; std::getline(text, line);) lines.push_back(line.substr(0, line.find('\0')));
  return lines;
}

Program idle_program() {
  Program program{"steplap", "parsed, not run", all_commands()};
  for (Command& command : program.commands) // what it would run owns the places of its options
    command.run = [kept = command.run](Console&) { return ExitCode::done; };
  return program;
}

const std::string& scene() {
  static const std::string text = [] {
    std::ostringstream stream;
    stream << std::ifstream(STEPLAP_FUZZ_SCENES "/block.toml").rdbuf();
    return std::move(stream).str();
  }();
  return text;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::string> arguments = lines_of(data, size);
  std::ostringstream out, err;
  const int code = run_program(idle_program(), arguments, out, err, false);
  fuzz::require(code == 0 || code == 2, "a command line is taken or refused");
  fuzz::require(code != 2 || !err.str().empty(), "a refusal says why");
  std::vector<std::string> overrides;
  for (std::size_t i = 1; i < arguments.size(); ++i)
    if (arguments[i - 1] == "--set") overrides.push_back(arguments[i]);
  try {
    (void)parse_model(scene(), STEPLAP_FUZZ_SCENES "/block.toml", transformer_catalog(), overrides);
  } catch (const ModelError& error) {
    fuzz::require_readable(error);
  }
  return 0;
}
