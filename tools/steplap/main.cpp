#include "tools/steplap/command_line.h"
#include "tools/steplap/interruption.h"
#include "tools/steplap/study.h"

#include <unistd.h>

#include <iostream>

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments.front() == "study") return steplap::run_study_program(argv + 1);
  const int code = steplap::run_command_line(arguments, std::cout, std::cerr, isatty(STDERR_FILENO) == 1);
  const int said = steplap::code_of_output(std::cout, std::cerr, code);
  steplap::end_by_noted_signal();
  return said;
}
